"""The cached rooms of ATISS and DiffuScene, read and written."""
