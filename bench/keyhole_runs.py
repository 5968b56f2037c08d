"""Running keyhole for benchmarks: one thread, CPU seconds from its own statistics, errors from `keyhole diff`."""
import json
import pathlib
import subprocess


class Keyhole:
    def __init__(self, program, folder):
        self.program = str(program)
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def render(self, scene, name, **settings):
        """Renders to FOLDER/NAME.exr; settings are those of -D. Returns (picture, statistics)."""
        picture, stats = self.folder / f"{name}.exr", self.folder / f"{name}.json"
        resolution = settings.pop("resolution", None)
        command = [self.program, "render", str(scene), "-o", str(picture), "--stats", str(stats), "--no-png", "-q", "-t", "1"]
        if resolution:
            command += ["--resolution", resolution]
        for key, value in settings.items():
            command += ["-D", f"{key}={value}"]
        subprocess.run(command, check=True)
        return picture, json.loads(stats.read_text())

    def references(self, scene, name, **settings):
        """Two independent pictures by path-space methods, made once."""
        pictures = []
        for seed in (1001, 1002):
            picture = self.folder / f"{name}_{seed}.exr"
            if not picture.exists():
                self.render(scene, f"{name}_{seed}", seed=seed, **settings)
            pictures.append(picture)
        return pictures

    def diff(self, picture, references):
        out = subprocess.run([self.program, "diff", str(picture), *map(str, references)], check=True, capture_output=True)
        return json.loads(out.stdout)

    def in_time(self, scene, name, seconds, **settings):
        """As many passes as take about `seconds` of CPU time, at least one."""
        _, stats = self.render(scene, name, passes=1, **settings)
        passes = max(1, round(seconds / cpu_seconds(stats)))
        return self.render(scene, name, passes=passes, **settings)


def cpu_seconds(stats):
    return sum(stage["cpu_seconds"] for stage in stats["stages"])
