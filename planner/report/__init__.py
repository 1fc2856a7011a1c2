"""A plan told on one page: what it amounts to, pictures, tables and the result of the check, in a file that needs
nothing else."""
