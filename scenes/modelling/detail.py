"""How finely curves are cut: the scenes proper, or a few hundred triangles for tests."""

from .solids import box, lathe, rounded_box, tube


class Detail:
    def __init__(self, fine):
        self.fine = fine

    def count(self, n, least=3):
        """`n` pieces of a curve, or a few."""
        return n if self.fine else max(least, n // 8)

    def block(self, lower, upper, radius, segments=2, inner=1, puff=0.0):
        return rounded_box(lower, upper, radius, segments, inner, puff) if self.fine else box(lower, upper)

    def lathe(self, profile, segments):
        return lathe(profile, self.count(segments, 6))

    def bar(self, points, radius, segments, closed=False):
        """A tube; coarse ones run through every fourth point only."""
        if not self.fine and len(points) > 4:
            keep = sorted({*range(0, len(points), len(points) // 4), *([] if closed else [len(points) - 1])})
            radius = [radius[i] for i in keep] if isinstance(radius, (list, tuple)) else radius
            points = [points[i] for i in keep]
        return tube(points, radius, self.count(segments), closed)
