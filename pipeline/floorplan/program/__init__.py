"""What is asked for: the typed program, completed by defaults, drawn from priors, checked for contradictions."""
