"""What benchmarks and verification share: windows, references, and how results are compared and told."""
