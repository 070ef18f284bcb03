"""The help texts of the command as data: the source of its man pages and of shell completion."""

import re
import subprocess
from dataclasses import dataclass, field

INDENT = 30  # column of the descriptions in the help
LAST_NOTES = re.compile(r" (?:Needs|Excludes):.*| REQUIRED| \.\.\.| x \d+")


@dataclass
class Entry:
    """An option, an argument or a subcommand."""

    names: list[str]  # without leading dashes only for arguments and subcommands
    value: str  # as in the help, such as 'INT in [0 - 4096]=0'; empty for flags and subcommands
    notes: list[str]  # such as 'REQUIRED' or 'Needs: --lightmap'
    text: str

    @property
    def is_option(self) -> bool:
        return self.names[0].startswith("-")

    @property
    def choices(self) -> list[str]:
        """The accepted words; empty if other values are possible."""
        words = self.value.partition("=")[0].split("|")
        return words if all(re.fullmatch(r"-?[a-z][a-z0-9/-]*", word) for word in words) else []

    @property
    def is_file(self) -> bool:
        return self.value.startswith("FILE")


@dataclass
class Page:
    """Help text of the command or of a subcommand."""

    words: list[str]  # such as ['interflect', 'make-scene', 'maze']
    summary: str
    usage: str
    groups: dict[str, list[Entry]] = field(default_factory=dict)  # by heading, in order
    footer: list[str] = field(default_factory=list)
    subpages: list["Page"] = field(default_factory=list)

    @property
    def options(self) -> list[Entry]:
        return [entry for group in self.groups.values() for entry in group if entry.is_option]

    def all_pages(self) -> list["Page"]:
        """This page and all below it."""
        return [self, *(below for page in self.subpages for below in page.all_pages())]


def read_help(command: str, *subcommands: str) -> Page:
    """Runs the command with --help-all. @raises ValueError for a line that is not as CLI11 writes help."""
    page = parse(["interflect", *subcommands], help_of(command, *subcommands, "--help"))
    if "Subcommands" not in page.groups:  # else --help-all would print theirs, too
        page = parse(page.words, help_of(command, *subcommands, "--help-all"))
    page.subpages = [read_help(command, *subcommands, entry.names[0]) for entry in page.groups.get("Subcommands", [])]
    return page


def help_of(*arguments: str) -> str:
    return subprocess.run(arguments, capture_output=True, text=True, check=True).stdout


def parse(words: list[str], text: str) -> Page:
    summary, usage, *lines = text.rstrip().split("\n")
    page = Page(words, summary, usage.removeprefix("Usage: "))
    if not usage.startswith("Usage: "):
        raise ValueError(f"{' '.join(words)}: expected 'Usage: ', found '{usage}'")
    group = None
    for number, line in enumerate(lines):
        following = lines[number + 1] if number + 1 < len(lines) else ""
        if not line or is_description(line):
            continue
        if line.startswith("  ") and group is not None:
            group.append(parse_entry(line, following))
        elif line.endswith(":") and following.startswith("  "):
            group = page.groups.setdefault(line[:-1], [])
        elif not line.startswith(" "):
            page.footer.append(line)
        else:
            raise ValueError(f"{' '.join(words)}: cannot read the line '{line}' of the help")
    return page


def is_description(line: str) -> bool:
    return line.startswith(" " * INDENT)


def parse_entry(line: str, following: str) -> Entry:
    """A long name fills its line, and its description follows; otherwise both share a line."""
    if is_description(following):
        head, text = line.strip(), following.strip()
    else:
        head, text = line[:INDENT].strip(), line[INDENT:].strip()
    notes = []
    while match := re.search(f"({LAST_NOTES.pattern})$", head):
        notes.insert(0, match[0].strip())
        head = head[: match.start()]
    names, _, value = head.partition(" ")
    value = re.sub(r"^\w+:(?=\w+ in \[)", "", value)  # 'N:INT in [1 - 9]': the name of the value is its type
    value = re.sub(r":\{.*\}", "", value)  # 'paper:{paper}'
    names = re.sub(r"\{[^}]*\}", "", names)  # the value of a flag
    return Entry(names.split(","), value, notes, text)
