"""What a browser paints, as lines: the reference that readings of drawings are held against."""
