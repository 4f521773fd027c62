"""Tables of results for other programs: Parquet, HDF5 and MATLAB files."""
