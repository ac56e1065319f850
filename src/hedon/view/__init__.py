"""Shows a run or a live world in a web page: the data of the page, the server, and the static site."""
