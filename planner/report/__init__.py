"""A plan told on one page: what it amounts to, pictures, tables and the check's verdict, in a file that needs nothing
else."""
