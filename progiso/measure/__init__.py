"""Share windows, references and tables between benchmarks and verification."""
