"""Files on disk: reading of untrusted files, atomic writing, locks."""

from evoframe.files.locks import LOCK_FILE, Lock, acquire_lock, locked, locked_after_others, released_on_error
from evoframe.files.reading import (
    DEEPEST,
    LARGEST_DOCUMENT,
    TOO_DEEP,
    encodable,
    exists,
    is_directory,
    is_file,
    is_too_deep,
    parsed_json,
    parsed_toml,
    read_text,
    refuse_links,
    shown_name,
)
from evoframe.files.writing import is_leftover, json_text, remove, write_atomically, write_json

__all__ = [
    "DEEPEST",
    "LARGEST_DOCUMENT",
    "LOCK_FILE",
    "TOO_DEEP",
    "Lock",
    "acquire_lock",
    "encodable",
    "exists",
    "is_directory",
    "is_file",
    "is_leftover",
    "is_too_deep",
    "json_text",
    "locked",
    "locked_after_others",
    "parsed_json",
    "parsed_toml",
    "read_text",
    "refuse_links",
    "released_on_error",
    "remove",
    "shown_name",
    "write_atomically",
    "write_json",
]
