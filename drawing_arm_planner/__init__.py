"""The entry of the command, under the distribution's own name.

The packages `planner` and `hardware` share their names with other distributions, which overwrite or remove their files.
No other has this one, so that what has happened can still be said from here. Nothing is imported from those two before
it is known whose they are.
"""
