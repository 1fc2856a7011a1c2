"""From an SVG drawing to a timed joint trajectory for an arm that holds a pen."""
