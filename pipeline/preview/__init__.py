"""Pictures of homes: top views, contact sheets, path-traced views."""
