"""Files of motions in every format: found, read, and written as BVH."""
