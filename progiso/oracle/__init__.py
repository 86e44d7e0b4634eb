"""References that the tests compare ProgIso with; numpy only, none of the project's own code."""
