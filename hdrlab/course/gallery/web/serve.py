"""The gallery's server: one process, with limits on headers, connections and patience."""

from pathlib import Path

import uvicorn

from hdrlab.course.gallery.web.app import Gallery, application

CONNECTIONS = 2000
HEADERS = 16_384  # bytes


def serve(folder: str | Path, address: str, *, host: str, port: int, behind_proxy: bool) -> None:
    """Serve the gallery until Ctrl-C.

    Nothing is logged of requests: a personal link is an address, and what is not written down cannot leak.
    What a proxy says of its clients is believed where there is one, on this machine, and not otherwise.
    """
    config = uvicorn.Config(
        application(Gallery(folder, address)),
        host=host,
        port=port,
        http="h11",  # which is strict about headers, and bounds them
        ws="none",
        access_log=False,
        log_level="warning",
        server_header=False,
        proxy_headers=behind_proxy,
        forwarded_allow_ips="127.0.0.1",
        limit_concurrency=CONNECTIONS,
        h11_max_incomplete_event_size=HEADERS,
        backlog=CONNECTIONS,
        timeout_keep_alive=20,
        timeout_graceful_shutdown=5,
    )
    uvicorn.Server(config).run()
