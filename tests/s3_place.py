"""A server of S3 on this machine, as all find it that read the environment."""

from importlib import import_module
from typing import Any

import pytest

KEY = "hedon-test-key"


def use_server(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names the server that listens at a port to this process and to those that it starts.

    fsspec reads the environment when it is imported, and keeps its file systems: what it has from the server of an
    earlier test is forgotten.
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
