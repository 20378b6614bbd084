"""Benchmarks: what each part costs, beside a reference that is measured in the same run."""
