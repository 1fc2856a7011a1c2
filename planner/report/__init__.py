"""A plan told on one page: what it amounts to, pictures, tables and the check's check result, in a file that needs
nothing else."""
