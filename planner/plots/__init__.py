"""Pictures of trajectories. Matplotlib enters here alone and takes a while to load, so whoever wants a
picture imports `profiles`, `drawing` or `figure_file` when it is time to draw one."""
