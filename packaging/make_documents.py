"""Makes the man pages, the shell completion and the changelog of a Debian package: make_documents.py COMMAND VERSION
CONTACT FOLDER. The files appear below FOLDER, arranged as in share/ of an installation. Their date is SOURCE_DATE_EPOCH [s], by
default now."""

import gzip
import os
import shutil
import sys
import time
from datetime import datetime, timezone
from email.utils import format_datetime
from pathlib import Path

import completions
from help_texts import Page, read_help
from man_pages import man_page, page_name


CHANGELOG = """\
interflect ({version}) unstable; urgency=medium

  * The changes are listed in CHANGELOG.md of the source.

 -- {contact}  {date}
"""


def make_documents(command: str, version: str, contact: str, folder: Path, moment: datetime) -> None:
    root = read_help(command)
    shutil.rmtree(folder, ignore_errors=True)

    parents = {id(below): page for page in root.all_pages() for below in page.subpages}
    for page in root.all_pages():
        text = man_page(page, parents.get(id(page)), version, f"{moment:%Y-%m-%d}")
        write_compressed(folder / "man/man1" / f"{page_name(page)}.1.gz", text)

    write(folder / "bash-completion/completions/interflect", completions.bash(root))
    write(folder / "zsh/vendor-completions/_interflect", completions.zsh(root))
    write(folder / "fish/vendor_completions.d/interflect.fish", completions.fish(root))

    changelog = CHANGELOG.format(version=version, contact=contact, date=format_datetime(moment))
    write_compressed(folder / "changelog.gz", changelog)


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def write_compressed(path: Path, text: str) -> None:
    """The same text gives the same bytes: the file has no date."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


if __name__ == "__main__":
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    *texts, folder = sys.argv[1:]
    make_documents(*texts, Path(folder), datetime.fromtimestamp(seconds, timezone.utc))
