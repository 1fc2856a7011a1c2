"""The entry of the command, which is installed under the distribution's own name as well, `drawing_arm_planner`.

The packages `planner` and `hardware` share their names with other distributions, which overwrite or remove their files.
No other has that one, so that what has happened can still be said from there. Nothing is imported from those two before
it is known whose they are.
"""
