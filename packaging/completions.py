"""Shell completion for bash, zsh and fish, made from the help texts: every subcommand, every option, and the words that
an option accepts. Other values are completed as files if the help names them FILE, and arguments always."""

from help_texts import Entry, Page

BASH = """\
# Completion of interflect for bash, made from its help texts.
_interflect() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} page=interflect word
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD - 1}}"; do
        case "$page $word" in
            {subpages}) page="$page $word" ;;
        esac
    done
    local options subcommands choices others  # others: options whose values are neither words nor files
    case $page in
{pages}
    esac
    COMPREPLY=()
    if [[ $choices ]]; then
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
    elif [[ " $others " == *" $previous "* ]]; then
        return
    elif [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
    elif [[ $subcommands ]]; then
        COMPREPLY=($(compgen -W "$subcommands" -- "$current"))
    else
        compopt -o default
    fi
}}
complete -F _interflect interflect
"""
BASH_PAGE = """\
        {page})
            options={options}
            subcommands={subcommands}
            others={others}
            case $previous in
{choices}
            esac
            ;;"""


def bash(root: Page) -> str:
    pages = root.all_pages()
    subpages = " | ".join(quoted(" ".join(page.words)) for page in pages[1:])
    return BASH.format(subpages=subpages, pages="\n".join(bash_page(page) for page in pages))


def bash_page(page: Page) -> str:
    others = [option for option in page.options if option.value and not option.choices and not option.is_file]
    choices = [f"                {' | '.join(option.names)}) choices={quoted(' '.join(option.choices))} ;;"
               for option in page.options if option.choices]
    return BASH_PAGE.format(
        page=quoted(" ".join(page.words)),
        options=quoted(names_of(page.options)),
        subcommands=quoted(" ".join(below.words[-1] for below in page.subpages)),
        others=quoted(names_of(others)),
        choices="\n".join(choices) or "                *) ;;",
    )


def names_of(options: list[Entry]) -> str:
    return " ".join(name for option in options for name in option.names)


ZSH = """\
#compdef interflect
# Completion of interflect for zsh, made from its help texts.
{functions}
_interflect "$@"
"""
ZSH_LEAF = """
{name}() {{
    _arguments -S \\
{specifications}
        '*:file:_files'
}}"""
ZSH_BRANCH = """
{name}() {{
    local state line
    _arguments -S -C \\
{specifications}
        '1:command:(({subcommands}))' \\
        '*:: :->chosen'
    [[ $state != chosen ]] || {name}_${{words[1]//-/_}}
}}"""


def zsh(root: Page) -> str:
    return ZSH.format(functions="\n".join(zsh_function(page) for page in root.all_pages()))


def zsh_function(page: Page) -> str:
    specifications = "\n".join(f"        {zsh_option(option, name)} \\" for option in page.options for name in option.names)
    subcommands = " ".join(rf'{below.words[-1]}\:"{zsh_text(below.summary)}"' for below in page.subpages)
    name = "_" + "_".join(page.words).replace("-", "_")
    form = ZSH_BRANCH if page.subpages else ZSH_LEAF
    return form.format(name=name, specifications=specifications, subcommands=subcommands)


def zsh_option(option: Entry, name: str) -> str:
    """'*' permits repetition; a completed long name may be followed by '=' or by a space."""
    text = f"*{name}{'=' if option.value and name.startswith('--') else ''}[{zsh_text(option.text)}]"
    if option.choices:
        text += f":value:({' '.join(option.choices)})"
    elif option.value:
        text += ":file:_files" if option.is_file else ": :"
    return quoted(text)


def zsh_text(text: str) -> str:
    for special in "\\[]:\"`$":
        text = text.replace(special, "\\" + special)
    return text


def fish(root: Page) -> str:
    lines = ["# Completion of interflect for fish, made from its help texts."]
    for page in root.all_pages():
        here = "__fish_use_subcommand" if page is root else f"__fish_seen_subcommand_from {page.words[-1]}"
        if page.subpages and page is not root:
            here += f"; and not __fish_seen_subcommand_from {' '.join(below.words[-1] for below in page.subpages)}"
        start = f"complete -c interflect -n {fish_quoted(here)}"
        lines += [f"{start} -f -a {below.words[-1]} -d {fish_quoted(below.summary)}" for below in page.subpages]
        lines += [f"{start} {fish_option(option)}" for option in page.options]
    return "\n".join(lines) + "\n"


def fish_option(option: Entry) -> str:
    parts = [f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in option.names]
    if option.choices:
        parts.append(f"-x -a {fish_quoted(' '.join(option.choices))}")
    elif option.value:
        parts.append("-r -F" if option.is_file else "-x")
    return " ".join([*parts, f"-d {fish_quoted(option.text)}"])


def quoted(text: str) -> str:
    """For bash and zsh."""
    return "'" + text.replace("'", r"'\''") + "'"


def fish_quoted(text: str) -> str:
    return "'" + text.replace("\\", r"\\").replace("'", r"\'") + "'"
