"""The gallery's pages: the application, what stands before it, and the server."""
