"""A small modeller for the furniture of our scenes: metres, y up, outsides anticlockwise."""
