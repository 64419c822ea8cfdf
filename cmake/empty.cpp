// Keeps a library with no source of its own valid.
