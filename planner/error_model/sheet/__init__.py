"""The calibration sheet: the marks that are meant, where its tags are, and the page to print."""
