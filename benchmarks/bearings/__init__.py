"""The bearing models of Matyja (2015): full, merged, simplified and improved, for accuracy and run time."""
