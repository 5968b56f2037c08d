#!/usr/bin/env python3
"""Measures the methods of primary sample space on the scenes of their papers: docs/primary-sample-space.md has the tables.

      primary_space.py [--keyhole build/keyhole] [--scenes glossy,egg] [--runs 8] large-steps | kelemen | failures | plot | speed

Pictures are small (--size), so that many independent runs fit; references are long bidirectional renders, kept in --work.
Numbers in brackets are standard errors. Needs numpy and OpenImageIO for Python (Debian: python3-numpy, python3-openimageio)."""

import argparse
import json
import pathlib
import subprocess
import sys

import numpy

from common import luminance

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ['glossy', 'egg', 'tube', 'ball', 'disco']
MODES = ['reject', 'exclude', 'exclude_large', 'delay']
SWEEP = [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0]


class Bench:
    def __init__(self, arguments):
        self.arguments = arguments
        self.work = pathlib.Path(arguments.work)
        self.work.mkdir(parents=True, exist_ok=True)

    def render(self, scene, seed=1, name='picture', **settings):
        """Luminance of the picture, and the run's statistics."""
        out, stats = self.work / f'{name}.exr', self.work / f'{name}.json'
        command = [self.arguments.keyhole, 'render', ROOT / 'scenes' / f'{scene}.yaml', '-q', '-t', '1', '--no-png', '-o', out,
                   '--stats', stats, '--resolution', self.arguments.size, '--seed', seed, '-D', 'brightness_samples=20k', '-D', 'chains=200']
        for key, value in settings.items():
            command += ['-D', f'{key}={value}']
        subprocess.run([str(c) for c in command], check=True)
        return luminance(out), json.loads(stats.read_text())

    def reference(self, scene):
        """Two independent long renders; their mean is the reference, their difference its noise."""
        halves = []
        for seed in (1001, 1002):
            path = self.work / f'{scene}.{self.arguments.size}.{seed}.exr'
            if not path.exists():
                self.render(scene, seed, path.stem, method='bdpt', spp=self.arguments.reference_spp)
            halves.append(luminance(path))
        return halves

    def method(self):
        """What --method and --builder say."""
        a = self.arguments
        return {'method': a.method, 'builder': a.builder} if a.method == 'pssmlt' else {'method': a.method}

    def results(self):
        return self.work / f'failures.{self.arguments.method}.json'

    def scenes(self):
        return self.arguments.scenes.split(',')


def error(picture, halves):
    """Trimmed relative mean square error, free of the reference's noise."""
    a, b = halves
    mean = (a + b) / 2
    values = (picture - a) * (picture - b) / (mean ** 2 + 0.01 * mean.mean() ** 2)
    values = numpy.sort(values.ravel())
    return float(values[:int(len(values) * 0.99)].mean())


def chain_seconds(stats):
    return sum(s['cpu_seconds'] for s in stats['stages'] if s['name'] == 'chains')


class Mean:
    """Mean of independent values, with its standard error."""

    def __init__(self, values):
        self.value = float(numpy.mean(values))
        self.error = float(numpy.std(values, ddof=1) / len(values) ** 0.5)

    def root(self):
        """Of a mean square: its root."""
        root = Mean.__new__(Mean)
        root.value = max(self.value, 0) ** 0.5
        root.error = self.error / (2 * root.value) if root.value > 0 else float('nan')
        return root

    def text(self, digits=3):
        return f'{self.value:.{digits}f} ({self.error:.{digits}f})'


def large_steps(bench):
    """The p_large that the rule chooses against a sweep of it: relative RMSE at equal mutations."""
    print('| scene | eta_s | eta_l | eta_0 | branch | p chosen | error | ' + ' | '.join(map(str, SWEEP)) + ' | chosen / best |')
    print('| --- ' * (8 + len(SWEEP)) + '|')
    for scene in bench.scenes():
        halves = bench.reference(scene)

        def runs(**settings):
            errors, values = [], []
            for seed in range(1, bench.arguments.runs + 1):
                picture, stats = bench.render(scene, seed, **bench.method(), mutations=bench.arguments.mutations, **settings)
                errors.append(error(picture, halves))
                values.append(stats['values'])
            return Mean(errors).root(), {k: numpy.mean([v[k] for v in values]) for k in
                                         ('eta_s', 'eta_l', 'eta_0', 'p_large', 'p_large by its first branch')}

        chosen, values = runs(p_large='auto')
        sweep = {p: runs(p_large=p)[0] for p in SWEEP}
        best = min(sweep.values(), key=lambda e: e.value)
        ratio = chosen.value / best.value
        spread = ratio * numpy.hypot(chosen.error / chosen.value, best.error / best.value)
        branch = 'formula' if values['p_large by its first branch'] > 0.5 else '1/4'
        print(f'| {scene} | ' + ' | '.join(f'{values[k]:.3f}' for k in ('eta_s', 'eta_l', 'eta_0')) +
              f' | {branch} | {values["p_large"]:.2f} | {chosen.text()} | ' +
              ' | '.join(('**' + e.text() + '**') if e is best else e.text() for e in sweep.values()) +
              f' | {ratio:.2f} ({spread:.2f}) |', flush=True)


def kelemen(bench):
    """Acceptance in either space; pixels whose relative error exceeds 10 %, with and without MIS of large steps."""
    print('| scene | accepted: mlt | pssmlt, small steps | large | all | > 10 % without MIS | with MIS |')
    print('| --- ' * 7 + '|')
    for scene in bench.scenes():
        a, b = bench.reference(scene)
        mean = (a + b) / 2

        def runs(**settings):
            shares, stats = [], []
            for seed in range(1, bench.arguments.runs + 1):
                picture, s = bench.render(scene, seed, **settings)
                shares.append(100 * float((abs(picture - mean) > 0.1 * mean).mean()))
                stats.append(s)
            return Mean(shares), stats

        mlt = bench.render(scene, method='mlt', mutations=bench.arguments.mutations)[1]
        proposed = sum(p['proposed'] for p in mlt['proposals'])
        accepted = sum(p['accepted'] for p in mlt['proposals']) / proposed
        settings = bench.method() | {'mutations': bench.arguments.mutations, 'p_large': 0.5}
        off, _ = runs(large_step_mis='off', **settings)
        on, stats = runs(large_step_mis='on', **settings)
        eta = [numpy.mean([s['values'][k] for s in stats]) for k in ('eta_s', 'eta_l', 'acceptance rate')]
        print(f'| {scene} | {accepted:.2f} | ' + ' | '.join(f'{e:.2f}' for e in eta) + f' | {off.text(1)} | {on.text(1)} |',
              flush=True)


def seconds_a_step(bench, scene, mode):
    """CPU seconds that a counted step costs: the least of three runs, for other programs only ever slow one down."""
    n = 40_000
    return min(chain_seconds(bench.render(scene, seed, **bench.method(), mutations=n, failures=mode)[1])
               for seed in (1, 2, 3)) / n


def split(pictures, halves):
    """Relative RMSE of independent pictures, and what of it is bias and what deviation. Nothing is trimmed, so that the
    squares add up; the references' noise is taken off."""
    a, b = halves
    stack = numpy.array(pictures)
    n = len(stack)
    weight = 1 / (((a + b) / 2) ** 2 + 0.01 * ((a + b) / 2).mean() ** 2)

    def bias2(some):
        m = some.mean(axis=0)
        return float((((m - a) * (m - b) - some.var(axis=0, ddof=1) / len(some)) * weight).mean())

    bias = Mean([0, 0])
    bias.value = bias2(stack)
    left = [bias2(numpy.delete(stack, i, axis=0)) for i in range(n)]  # jackknife
    bias.error = float(numpy.std(left) * (n - 1) ** 0.5)
    deviation = float((stack.var(axis=0, ddof=1) * weight).mean())
    rmse = Mean([float(((p - a) * (p - b) * weight).mean()) for p in stack])
    return {'bias': max(bias.value, 0) ** 0.5, 'bias2': bias.value, 'bias2_error': bias.error,
            'deviation': deviation ** 0.5, 'rmse': rmse.root().value, 'rmse_error': rmse.root().error}


def bias_text(row):
    """Squares may come out negative; what is within two standard errors of 0 has only a bound."""
    if row['bias2'] > 2 * row['bias2_error']:
        return f'{row["bias"]:.3f}'
    return f'< {(max(row["bias2"], 0) + 2 * row["bias2_error"]) ** 0.5:.3f}'


def failures(bench):
    """Bias and deviation of each treatment of failed proposals, from independent runs of equal CPU time."""
    print('| scene | CPU s | failures | failed | accepted | remedied | bias | deviation | RMSE |')
    print('| --- ' * 9 + '|')
    rows = json.loads(bench.results().read_text()) if bench.results().exists() else []
    for scene in bench.scenes():
        halves = bench.reference(scene)
        cost = {mode: seconds_a_step(bench, scene, mode) for mode in MODES}
        for seconds in map(float, bench.arguments.seconds.split(',')):
            for mode in MODES:
                pictures, stats = zip(*(bench.render(scene, seed, **bench.method(), failures=mode,
                                                     mutations=round(seconds / cost[mode]))
                                        for seed in range(1, bench.arguments.runs + 1)))
                rates = {k: float(numpy.mean([s['values'][k] for s in stats]))
                         for k in ('failure rate', 'acceptance rate', 'remedied paths')}
                row = {'scene': scene, 'method': bench.arguments.method, 'failures': mode, 'seconds': seconds,
                       'measured seconds': float(numpy.mean([chain_seconds(s) for s in stats])), **rates,
                       **split(pictures, halves)}
                rows.append(row)
                print(f'| {scene} | {seconds} | {mode} | ' + ' | '.join(f'{r:.2f}' for r in rates.values()) +
                      f' | {bias_text(row)} | {row["deviation"]:.3f} | {row["rmse"]:.3f} ({row["rmse_error"]:.3f}) |',
                      flush=True)
                bench.results().write_text(json.dumps(rows, indent=1))


def plot(bench):
    """Error times the root of time, against time, of the rows that `failures` left, by scene: noise alone lies level. Lines: the bias that all rows together tell, if it is
    distinguishable from 0, and a deviation that falls with the root of time, by their median."""
    import matplotlib
    matplotlib.use('Agg')
    matplotlib.rcParams.update({'svg.hashsalt': 'keyhole', 'svg.fonttype': 'none', 'font.size': 9})
    from matplotlib import pyplot
    rows = json.loads(bench.results().read_text())
    figure, axes = pyplot.subplots(1, len(bench.scenes()), figsize=(4.2 * len(bench.scenes()), 3.6), layout='constrained')
    for axis, scene in zip(numpy.atleast_1d(axes), bench.scenes()):
        for mode, colour, marker in zip(MODES, ('#444444', '#d62728', '#1f77b4', '#2ca02c'), 'osv^'):
            mine = sorted((r for r in rows if r['scene'] == scene and r['failures'] == mode), key=lambda r: r['seconds'])
            axis.errorbar([r['seconds'] for r in mine], *([r[k] * r['seconds'] ** 0.5 for r in mine]
                                                          for k in ('rmse', 'rmse_error')),
                          color=colour, marker=marker, markersize=4, linewidth=0, elinewidth=1, label=mode)
            trust = [r['bias2_error'] ** -2 for r in mine]
            bias2 = numpy.average([r['bias2'] for r in mine], weights=trust)
            if bias2 < 2 * sum(trust) ** -0.5:
                bias2 = 0
            times = numpy.geomspace(mine[0]['seconds'], 4 * mine[-1]['seconds'], 50)
            variance = numpy.median([r['deviation'] ** 2 * r['seconds'] for r in mine])
            axis.plot(times, (bias2 * times + variance) ** 0.5, color=colour, linewidth=1)
        axis.set(xscale='log', title=scene, xlabel='CPU seconds')
    numpy.atleast_1d(axes)[0].set_ylabel('relative RMSE × √(CPU seconds)')
    numpy.atleast_1d(axes)[0].legend(frameon=False)
    figure.savefig(bench.arguments.figure, metadata={'Date': None})


def speed(bench):
    """Thousand mutations for each second of CPU time, chains only: the best of the runs, as of seconds_a_step()."""
    print('| scene | ' + ' | '.join(name for name, _ in METHODS) + ' |')
    print('| --- |' + ' --- |' * len(METHODS))
    for scene in bench.scenes():
        cells = []
        for _, settings in METHODS:
            runs = [bench.render(scene, seed, mutations=bench.arguments.mutations, **settings)[1]
                    for seed in range(1, bench.arguments.runs + 1)]
            cells.append(f'{max(r["values"]["mutations"] / chain_seconds(r) for r in runs) / 1000:.0f}')
        print(f'| {scene} | ' + ' | '.join(cells) + ' |', flush=True)


METHODS = [('pssmlt path', {'method': 'pssmlt', 'builder': 'path'}),
           ('pssmlt endpoints', {'method': 'pssmlt', 'builder': 'endpoints'}),
           ('pssmlt bidirectional', {'method': 'pssmlt', 'builder': 'bidirectional'}),
           ('mmlt', {'method': 'mmlt'}), ('rjmlt', {'method': 'rjmlt'})]

MEASURES = {'large-steps': large_steps, 'kelemen': kelemen, 'failures': failures, 'plot': plot, 'speed': speed}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--keyhole', default=str(ROOT / 'build' / 'keyhole'))
    parser.add_argument('--work', default='/tmp/primary_space', help='folder for pictures')
    parser.add_argument('--scenes', default=','.join(SCENES))
    parser.add_argument('--runs', type=int, default=8)
    parser.add_argument('--size', default='64x48')
    parser.add_argument('--seconds', default='0.05,0.6', help='CPU time of the runs of `failures`')
    parser.add_argument('--figure', default='failures.svg', help='file that `plot` writes')
    parser.add_argument('--mutations', type=int, default=100_000)
    parser.add_argument('--reference-spp', type=int, default=1024)
    parser.add_argument('--method', default='pssmlt')
    parser.add_argument('--builder', default='path')
    parser.add_argument('measure', choices=MEASURES)
    arguments = parser.parse_args()
    MEASURES[arguments.measure](Bench(arguments))


if __name__ == '__main__':
    sys.exit(main())
