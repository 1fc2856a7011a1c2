"""What `import planner` offers to programs. The names are those of `planner.__all__`; all else is private."""
