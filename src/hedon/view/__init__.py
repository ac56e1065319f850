"""Watch a run, or a live world, in a web page: what the page is told, the server, and the static site."""
