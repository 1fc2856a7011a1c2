"""Pictures and films of trajectories. Matplotlib enters here alone and takes a while to load, so whoever wants a
picture imports the module of its kind, and `figure_file` or `film_file`, when it is time to draw one."""
