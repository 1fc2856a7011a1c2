"""A distribution of its own for the small computer beside the arm: it plays trajectories, and plans none."""
