"""Where a student's functions run: apart from who scores them, in one of three tiers."""
