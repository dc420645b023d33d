# What tests/fuzz uses of the fuzzer atheris, which has no types of its own.
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager

def instrument_imports(
    include: Sequence[str] = ..., exclude: Sequence[str] = ..., enable_loader_override: bool = ...
) -> AbstractContextManager[None]: ...
def Setup(  # noqa: N802
    args: Sequence[str],
    test_one_input: Callable[[bytes], None],
    *,
    custom_mutator: Callable[[bytes, int, int], bytes] | None = ...,
) -> list[str]: ...
def Fuzz() -> None: ...  # noqa: N802
def Mutate(data: bytes, max_size: int, /) -> bytes: ...  # noqa: N802
