"""Minimal shadow package for generated cydr codecs."""
