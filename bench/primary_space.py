#!/usr/bin/env python3
"""Measures the methods of primary sample space on the scenes of their papers: docs/primary-sample-space.md has the tables.

      primary_space.py [--keyhole build/keyhole] [--scenes glossy,egg] [--runs 32] large-steps | kelemen | failures | speed

Pictures are small (see SIZE), so that many independent runs fit; references are long bidirectional renders, kept in --work.
Needs numpy and OpenImageIO for Python."""

import argparse
import json
import pathlib
import subprocess
import sys

import numpy
import OpenImageIO as oiio

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = '64x48'
SCENES = ['glossy', 'egg', 'tube', 'ball', 'disco']
SWEEP = [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0]


class Bench:
    def __init__(self, arguments):
        self.arguments = arguments
        self.work = pathlib.Path(arguments.work)
        self.work.mkdir(parents=True, exist_ok=True)

    def render(self, scene, seed=1, name='picture', **settings):
        """Luminance of the picture, and the run's statistics."""
        out, stats = self.work / f'{name}.exr', self.work / f'{name}.json'
        command = [self.arguments.keyhole, 'render', ROOT / 'scenes' / f'{scene}.yaml', '-q', '-t', '1', '--no-png', '-o', out,
                   '--stats', stats, '--resolution', SIZE, '--seed', seed, '-D', 'brightness_samples=50k', '-D', 'chains=200']
        for key, value in settings.items():
            command += ['-D', f'{key}={value}']
        subprocess.run([str(c) for c in command], check=True)
        return luminance(out), json.loads(stats.read_text())

    def reference(self, scene):
        """Two independent long renders; their mean is the reference, their difference its noise."""
        halves = []
        for seed in (1001, 1002):
            path = self.work / f'{scene}.{seed}.exr'
            if not path.exists():
                self.render(scene, seed, f'{scene}.{seed}', method='bdpt', spp=self.arguments.reference_spp)
            halves.append(luminance(path))
        return halves

    def scenes(self):
        return self.arguments.scenes.split(',')


def luminance(path):
    pixels = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)
    names = oiio.ImageBuf(str(path)).spec().channelnames
    return sum(w * pixels[..., names.index(c)] for w, c in ((0.2126, 'R'), (0.7152, 'G'), (0.0722, 'B'))).astype(float)


def error(picture, halves):
    """Trimmed relative mean square error, free of the reference's noise."""
    a, b = halves
    mean = (a + b) / 2
    values = (picture - a) * (picture - b) / (mean ** 2 + 0.01 * mean.mean() ** 2)
    values = numpy.sort(values.ravel())
    return float(values[:int(len(values) * 0.99)].mean())


def chain_seconds(stats):
    return sum(s['cpu_seconds'] for s in stats['stages'] if s['name'] == 'chains')


def large_steps(bench):
    """Chosen p_large against a sweep of it: root of the mean error over runs at equal mutations."""
    print('| scene | eta_s | eta_l | eta_0 | branch | p chosen | error | best of sweep | error |')
    print('| --- | --- | --- | --- | --- | --- | --- | --- | --- |')
    for scene in bench.scenes():
        halves = bench.reference(scene)

        def rmse(**settings):
            errors = [error(bench.render(scene, seed, method='pssmlt', mutations=bench.arguments.mutations, **settings)[0],
                            halves) for seed in range(1, bench.arguments.runs + 1)]
            return max(numpy.mean(errors), 0) ** 0.5

        values = bench.render(scene, method='pssmlt', mutations=bench.arguments.mutations)[1]['values']
        chosen = rmse(p_large=values['p_large'])
        sweep = {p: rmse(p_large=p) for p in SWEEP}
        best = min(sweep, key=sweep.get)
        branch = 'formula' if values['p_large by its first branch'] else '1/4'
        print(f'| {scene} | {values["eta_s"]:.3f} | {values["eta_l"]:.3f} | {values["eta_0"]:.3f} | {branch} | '
              f'{values["p_large"]:.3f} | {chosen:.4f} | {best} | {sweep[best]:.4f} |', flush=True)
        print('  <!-- ' + ', '.join(f'{p}: {e:.4f}' for p, e in sweep.items()) + ' -->', flush=True)


def kelemen(bench):
    """Pixels whose relative error exceeds 10 %, with and without MIS of large steps; acceptance in either space."""
    print('| scene | acceptance | off: error > 10 % | on: error > 10 % |')
    print('| --- | --- | --- | --- |')
    for scene in bench.scenes():
        a, b = bench.reference(scene)
        mean = (a + b) / 2
        shares, acceptance = {}, 0
        for mis in ('off', 'on'):
            bad = []
            for seed in range(1, bench.arguments.runs + 1):
                picture, stats = bench.render(scene, seed, method='pssmlt', mutations=bench.arguments.mutations,
                                              large_step_mis=mis, p_large=0.5)
                bad.append(float((abs(picture - mean) > 0.1 * mean).mean()))
                acceptance = stats['values']['eta_s']
            shares[mis] = numpy.mean(bad)
        print(f'| {scene} | {acceptance:.3f} | {shares["off"]:.1%} | {shares["on"]:.1%} |', flush=True)


def failures(bench):
    """Bias and deviation of each treatment of failed proposals, short and long, from independent runs."""
    print('| scene | mutations | failures | failed | accepted | remedied | CPU s | bias | deviation | rmse |')
    print('| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |')
    for scene in bench.scenes():
        a, b = bench.reference(scene)
        weight = 1 / (((a + b) / 2) ** 2 + 0.01 * ((a + b) / 2).mean() ** 2)
        for mutations in (bench.arguments.mutations, 8 * bench.arguments.mutations):
            for mode in ('reject', 'exclude', 'exclude_large', 'delay'):
                pictures, seconds, values = [], [], {}
                for seed in range(1, bench.arguments.runs + 1):
                    picture, stats = bench.render(scene, seed, method=bench.arguments.method, mutations=mutations,
                                                  failures=mode, builder=bench.arguments.builder)
                    pictures.append(picture)
                    seconds.append(chain_seconds(stats))
                    values = stats['values']
                stack = numpy.array(pictures)
                variance = stack.var(axis=0, ddof=1)
                mean = stack.mean(axis=0)
                bias2 = ((mean - a) * (mean - b) - variance / len(stack)) * weight
                bias2 = float(numpy.mean(bias2))
                deviation2 = float(numpy.mean(variance * weight))
                print(f'| {scene} | {mutations} | {mode} | {values["failure rate"]:.3f} | {values["acceptance rate"]:.3f} | '
                      f'{values["remedied paths"]:.3f} | {numpy.mean(seconds):.2f} | {max(bias2, 0) ** 0.5:.4f} | '
                      f'{deviation2 ** 0.5:.4f} | {max(bias2 + deviation2, 0) ** 0.5:.4f} |', flush=True)


def speed(bench):
    """Thousand mutations for each second of CPU time, chains only."""
    print('| scene | ' + ' | '.join(name for name, _ in METHODS) + ' |')
    print('| --- |' + ' --- |' * len(METHODS))
    for scene in bench.scenes():
        cells = []
        for _, settings in METHODS:
            stats = bench.render(scene, mutations=bench.arguments.mutations, **settings)[1]
            cells.append(f'{stats["values"]["mutations"] / chain_seconds(stats) / 1000:.0f}')
        print(f'| {scene} | ' + ' | '.join(cells) + ' |', flush=True)


METHODS = [('pssmlt path', {'method': 'pssmlt', 'builder': 'path'}),
           ('pssmlt endpoints', {'method': 'pssmlt', 'builder': 'endpoints'}),
           ('pssmlt bidirectional', {'method': 'pssmlt', 'builder': 'bidirectional'}),
           ('mmlt', {'method': 'mmlt'})]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--keyhole', default=str(ROOT / 'build' / 'keyhole'))
    parser.add_argument('--work', default='/tmp/primary_space', help='folder for pictures')
    parser.add_argument('--scenes', default=','.join(SCENES))
    parser.add_argument('--runs', type=int, default=32)
    parser.add_argument('--mutations', type=int, default=100_000)
    parser.add_argument('--reference-spp', type=int, default=4096)
    parser.add_argument('--method', default='pssmlt')
    parser.add_argument('--builder', default='path')
    parser.add_argument('measure', choices=['large-steps', 'kelemen', 'failures', 'speed'])
    arguments = parser.parse_args()
    bench = Bench(arguments)
    {'large-steps': large_steps, 'kelemen': kelemen, 'failures': failures, 'speed': speed}[arguments.measure](bench)


if __name__ == '__main__':
    sys.exit(main())
