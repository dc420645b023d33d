"""Build of another commit, beside this version of evoframe."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import attrs

from benchmarks.report import SectionError

__all__ = ["Build", "build", "describe"]

_LINES = 30  # of the output of a command that failed; pip ends with advice


@attrs.frozen
class Build:
    """A commit that was built.

    Attributes:
        about: Abbreviated hash and subject of the commit.
        site: Folder with its packages, for ``PYTHONPATH``.
    """

    about: str
    site: Path


def describe(root: Path) -> str:
    """Return hash and subject of the commit of a checkout, and whether files differ from it.

    Raises:
        SectionError: git is missing, or *root* is not a checkout.
    """
    changed = _git(root, "status", "--porcelain", "--untracked-files=no")
    return _about(root, "HEAD") + (", with uncommitted changes" if changed else "")


def build(root: Path, revision: str, directory: Path) -> Build:
    """Build the packages of a commit of the checkout *root* in an empty directory.

    The packages that evoframe requires are those of this environment. Only what the commit requires in
    addition, or in another version, is installed from the package index.

    Raises:
        SectionError: git is missing, *revision* is unknown, or the build fails.
    """
    commit = _commit(root, revision)
    tree, site = directory / "tree", directory / "site"
    archive = _git(root, "archive", "--format=zip", commit)
    zipfile.ZipFile(io.BytesIO(archive)).extractall(tree)
    about = _about(root, commit)
    failure = f"cannot build {about}"
    _install(site, [str(tree)], failure)
    if missing := _missing(site, failure):
        _install(site, missing, failure)
    return Build(about, site)


def _commit(root: Path, revision: str) -> str:
    failure = f"'{revision}' is not a commit of {root}"
    return _git(root, "rev-parse", "--verify", f"{revision}^{{commit}}", failure=failure).decode().strip()


def _about(root: Path, commit: str) -> str:
    return _git(root, "log", "-1", "--format=%h %s", commit).decode().strip()


def _git(root: Path, *arguments: str, failure: str = "--against requires git and a checkout") -> bytes:
    return _output(["git", "--no-optional-locks", "-C", str(root), *arguments], failure)


def _install(site: Path, packages: Sequence[str], failure: str) -> None:
    options = ["--no-deps", "--no-build-isolation", "--target", str(site)]
    _output(_pip("install", *options, *packages), failure)


def _missing(site: Path, failure: str) -> list[str]:
    """Return the requirements of the built packages that this environment does not fulfill."""
    command = _pip("install", "--dry-run", "--report", "-", "evoframe")
    report = json.loads(_output(command, failure, {"PYTHONPATH": str(site)}))
    return ["{name}=={version}".format(**package["metadata"]) for package in report["install"]]


def _pip(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", *arguments]


def _output(command: Sequence[str], failure: str, environment: Mapping[str, str] | None = None) -> bytes:
    """Return the output of a command, or raise an error with the end of what it printed."""
    try:
        return subprocess.run(
            command, check=True, capture_output=True, env={**os.environ, **(environment or {})}
        ).stdout
    except OSError as error:
        raise SectionError(f"{failure}: {command[0]}: {error.strerror}") from error
    except subprocess.CalledProcessError as error:
        lines = error.stderr.decode(errors="replace").strip().splitlines()[-_LINES:]
        raise SectionError("\n  ".join([f"{failure}:", *lines])) from error
