"""From the rows of a study to what can be said about it; needs the extra ``report``."""
