"""What the measurements share: renders whose CPU time is taken or given, how far pictures are from others, and their luminance."""
import json
import resource
import subprocess


def cpu_seconds():
    """CPU time [s] that the programs used which this one has started and waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render(keyhole, scene, settings, picture, *options):
    """Renders on one thread; `settings` are KEY=VALUE. Returns the CPU time [s]."""
    before = cpu_seconds()
    subprocess.run([keyhole, "render", scene, "-q", "-t", "1", "--no-png", "-o", picture, *options]
                   + [word for s in settings for word in ("-D", s)], check=True)
    return cpu_seconds() - before


def render_for(keyhole, scene, seconds, method, seed, resolution, picture, *options):
    """Renders on one thread for so many CPU seconds."""
    subprocess.run([keyhole, "render", str(scene), "-q", "-t", "1", "--no-png", "-o", str(picture), "--resolution", resolution,
                    "--method", method, "--seed", str(seed), "--cpu-time", str(seconds), *options], check=True)


def diff(keyhole, *pictures):
    """How far the first picture is from one or two references: what `keyhole diff` says."""
    told = subprocess.run([keyhole, "diff", *map(str, pictures)], check=True, capture_output=True, text=True)
    return json.loads(told.stdout)


def luminance(path, layer=""):
    """Luminance of a layer of an EXR, the picture itself by default: rows of float64."""
    # Here, so that what reads no pictures does without them.
    import numpy
    import OpenImageIO as oiio
    file = oiio.ImageInput.open(str(path))  # not ImageBuf, whose cache takes files of the same second for the same
    names = file.spec().channelnames
    pixels = file.read_image(oiio.FLOAT)
    file.close()
    prefix = layer + "." if layer else ""
    return pixels[..., [names.index(prefix + c) for c in "RGB"]] @ numpy.array([0.2126, 0.7152, 0.0722])
