"""What could not be exported, by object and node."""


class Messages:
    """Lines without repetitions, in the order in which they came."""

    def __init__(self):
        self.lines = []

    def add(self, where, text):
        """`where`: the object, or the material and node; `text`: what about it was not exported, and what was instead."""
        line = f"{where}: {text}"
        if line not in self.lines:
            self.lines.append(line)
