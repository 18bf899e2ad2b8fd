"""The mutants of one source: small mistakes, each in one place. The format of the tree tells an operator, which has a space
on both sides, from a bracket of a template or a reference."""

import re
from dataclasses import dataclass

SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+": "-", "-": "+",
         "+=": "-=", "-=": "+="}
OPERATOR = re.compile(r"(?<= )(" + "|".join(map(re.escape, sorted(SWAPS, key=len, reverse=True))) + r")(?=[ \n])")
NOT = re.compile(r"(?<![\w)])!(?=[\w(*:])")
NUMBER = re.compile(r"(?<![\w.'\"])(?:\d+\.\d*(?:e-?\d+)?|\d+e-?\d+|\d+)[uUlL]*(?![\w.'])")
TRUTH = re.compile(r"(?<=return )(true|false)(?=;)")
NAME = re.compile(r"(?<=return )\"{3,}(?=;)")  # masked: a text that is an answer by itself
# A label of a switch is none: the same twice does not compile, and one that is left out is mostly what stands behind.
ENUMERATOR = re.compile(r"(?<![\w:])(?<!case )((?:\w+::)+)(k[A-Z]\w*)(?![\w(])")
STATEMENT = re.compile(r"(?:(?<=[{})])\s+|(?<=;)\s*\n\s*)((?:(?:\+\+|\()?[\w:][^;{}=\n]*\([^;{}]*\)|[\w:.>\[\]-]+ = [^;{}]+|\+\+[^;{}]+);)")
NO_STATEMENT = re.compile(r"(return|co_return|throw|static_assert|using|case|const|constexpr|else|if|for|while|switch|template|[\w:<>]+ [\w:]+\()")
SKIPPED_LINE = re.compile(r"\s*(#|static_assert|assert|template <|requires |using |namespace )")


@dataclass(frozen=True)
class Mutant:
    line: int  # from 1
    begin: int  # where in the text
    end: int
    before: str
    after: str
    nth: int  # of the same mutation in its line, from 1

    def name(self):
        words = f"{' '.join(self.before.split())} -> {self.after or 'nothing'}"
        return words if self.nth == 1 else f"{words} #{self.nth}"

    def of(self, text):
        return text[: self.begin] + self.after + text[self.end:]


def _masked(text):
    """The same length without what is in comments, strings, characters and lines that are skipped."""
    blank = lambda found: re.sub(r"[^\n]", "\"" if found.group()[0] in "\"'" else " ", found.group())
    text = re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|(?<!\d)'(?:\\.|[^'\\\n])'", blank, text, flags=re.S)
    lines = text.split("\n")
    return "\n".join(" " * len(line) if SKIPPED_LINE.match(line) else line for line in lines)


def _places(masked, text):
    for found in OPERATOR.finditer(masked):
        yield found.start(1), found.end(1), SWAPS[found.group(1)]
    for found in NOT.finditer(masked):
        yield found.start(), found.end(), ""
    for found in NUMBER.finditer(masked):
        yield found.start(), found.end(), f"({found.group()} + 1)"
    for found in TRUTH.finditer(masked):
        yield found.start(), found.end(), "false" if found.group() == "true" else "true"
    for found in NAME.finditer(masked):
        if " " in text[found.start():found.end()]:
            continue  # words for a person, which no test repeats
        yield found.start(), found.end(), text[found.start():found.end() - 1] + "~\""
    for found in ENUMERATOR.finditer(masked):
        if other := _another(masked, found.group(1), found.group(2)):
            yield found.start(), found.end(), found.group(1) + other
    for found in STATEMENT.finditer(masked):
        if not NO_STATEMENT.match(found.group(1)):
            yield found.start(1), found.end(1), ";"


def _another(masked, enumeration, value):
    """The value of the same enumeration that the source names next; the first one behind the last."""
    named = list(dict.fromkeys(re.findall(r"(?<![\w:])" + re.escape(enumeration) + r"(k[A-Z]\w*)", masked)))
    return named[(named.index(value) + 1) % len(named)] if len(named) > 1 else None


def mutants_of(text):
    seen, mutants = {}, []
    for begin, end, after in sorted(_places(_masked(text), text)):
        line = text.count("\n", 0, begin) + 1
        key = (line, text[begin:end], after)
        seen[key] = seen.get(key, 0) + 1
        mutants.append(Mutant(line, begin, end, text[begin:end], after, seen[key]))
    return mutants
