"""`unicon motions import`: from files to a library."""
