"""What a study says, for people: a table, sentences, figures and a page."""
