"""The page: a small server on this machine, before the same commands that a terminal has."""
