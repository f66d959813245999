"""The table, with a module for each of OpenDR's packages: ``MODULES`` (module paths, names, homes) and ``LEARNERS``."""
