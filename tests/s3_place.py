"""A local S3 server, configured through environment variables."""

from importlib import import_module
from typing import Any

import pytest

KEY = "hedon-test-key"


def use_server(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Points this process and its child processes to the server that listens on a port.

    fsspec reads the environment on import and caches its file systems, so those from the server of an earlier test are
    cleared.
    """
    address = f"http://127.0.0.1:{port}"
    for name, value in {
        "AWS_ENDPOINT_URL": address,
        "FSSPEC_S3_ENDPOINT_URL": address,
        "AWS_ACCESS_KEY_ID": KEY,
        "AWS_SECRET_ACCESS_KEY": KEY,
        "AWS_DEFAULT_REGION": "us-east-1",
    }.items():
        monkeypatch.setenv(name, value)
    config: Any = import_module("fsspec.config")
    config.set_conf_env(config.conf)
    import_module("s3fs").S3FileSystem.clear_instance_cache()
