"""A photo or a scan of a drawn calibration sheet: where the marks came, and how high the tip was over them."""
