"""Tests of the exact arithmetic."""
