"""Man pages in the language of man(7), made from the help texts."""

import textwrap

from help_texts import Entry, Page

LINE = 72  # [characters] of the source
ESCAPES = {"\\": r"\e", "-": r"\-", "'": r"\(aq", "`": r"\(ga", "^": r"\(ha", "~": r"\(ti"}  # the first comes first
HEADINGS = {"Positionals": "ARGUMENTS", "Options": "OPTIONS", "Subcommands": "COMMANDS"}  # others are parts of OPTIONS


def man_page(page: Page, parent: Page | None, version: str, date: str) -> str:
    """@param date  Of the version, as YYYY-MM-DD."""
    name, program = page_name(page), " ".join(page.words)
    lines = [f'.TH "{name.upper()}" 1 "{date}" "interflect {version}" "User Commands"', ".ad l", ".nh"]
    lines += [".SH NAME", rf"{escaped(name)} \- {escaped(page.summary.removeprefix('Interflect: '))}"]
    lines += [".SH SYNOPSIS", f".B {escaped(program)}", escaped(page.usage.removeprefix(program).strip())]
    for heading, entries in page.groups.items():
        lines.append(f".SH {HEADINGS[heading]}" if heading in HEADINGS else f".SS {escaped(heading)}")
        lines += [line for entry in entries for line in described(entry)]
    if page.footer:
        lines.append(".SH NOTES")
        lines += [line for paragraph in page.footer for line in (".PP", *wrapped(paragraph))][1:]
    others = [*([parent] if parent else []), *page.subpages]
    if others:
        references = [rf".BR {escaped(page_name(other))} (1)" for other in others]
        lines += [".SH SEE ALSO", *(f"{reference}," for reference in references[:-1]), references[-1]]
    return "\n".join(lines) + "\n"


def page_name(page: Page) -> str:
    return "-".join(page.words)


def described(entry: Entry) -> list[str]:
    term = ", ".join(rf"\fB{escaped(name)}\fP" for name in entry.names)
    if entry.value:
        term += rf" \fI{breakable(escaped(entry.value))}\fP"
    if "..." in entry.notes:
        term += " ..."
    notes = [note[0].lower() + note[1:] for note in entry.notes if ":" in note]
    if "REQUIRED" in entry.notes:
        notes.insert(0, "required")
    return [".TP", term, *wrapped(entry.text), *(wrapped(f"({'; '.join(notes)})") if notes else [])]


def breakable(text: str) -> str:
    """Lists of words and long forms may continue on the next line after these characters."""
    for separator in "|,]":
        text = text.replace(separator, separator + r"\:")
    return text


def wrapped(text: str) -> list[str]:
    lines = textwrap.wrap(text, LINE, break_long_words=False, break_on_hyphens=False)
    return [protected(escaped(line)) for line in lines]


def escaped(text: str) -> str:
    """The characters that man(7) would draw as typographic ones or interpret."""
    for character, escape in ESCAPES.items():
        text = text.replace(character, escape)
    return text


def protected(line: str) -> str:
    """A line that begins with a dot would be a request."""
    return r"\&" + line if line.startswith(".") else line
