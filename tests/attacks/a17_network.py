"""Ask a server for the answer."""

import socket

PORT = 0


def double(x):
    with socket.create_connection(("127.0.0.1", PORT), timeout=2) as server:
        return float(server.recv(1)) * x
