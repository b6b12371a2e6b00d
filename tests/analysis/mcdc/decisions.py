"""Finds the decisions with two or more conditions, joined by && or ||, in C++ sources."""
import collections
import re

Decision = collections.namedtuple("Decision", "function text conditions")
Condition = collections.namedtuple("Condition", "text begin end")  # begin, end: its position in the source

_QUIET = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)
_OPERATOR = re.compile(r"&&|\|\|")
_OPENS, _CLOSES = "([{", ")]}"
_DEFINITION = re.compile(r"^ {0,2}(?:\[\[[\w:]+\]\] )?(?:[\w:<>,&*]+ )*[&*]*(?:\w+(?:<\w+>)?::)?(\w+)\(", re.M)
_KEYWORDS = {"if", "for", "while", "switch", "return", "static_assert", "sizeof"}


def quiet(source):
    """The source with comments and literals replaced by blanks; all positions stay the same."""
    return _QUIET.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source)


def squeezed(text):
    return " ".join(text.split())


def _begin(code, at):
    """Start of the expression that extends to `at`: after the enclosing bracket, or after ; , = ? : or return."""
    depth, i = 0, at
    while i > 0:
        one = code[i - 1]
        if one in _CLOSES:
            depth += 1
        elif one in _OPENS:
            if depth == 0:
                return i
            depth -= 1
        elif depth == 0 and (one in ";,?" or code[:i].endswith("return ")):
            return i
        elif depth == 0 and one == ":" and code[i - 2] != ":" and code[i] != ":":
            return i
        elif depth == 0 and one == "=" and code[i - 2] not in "=!<>" and code[i] != "=":
            return i
        i -= 1
    return 0


def _end(code, at):
    depth, i = 0, at
    while i < len(code):
        one = code[i]
        if one in _OPENS:
            depth += 1
        elif one in _CLOSES:
            if depth == 0:
                return i
            depth -= 1
        elif depth == 0 and one in ";,?":
            return i
        i += 1
    return i


def _is_grouping(code, begin):
    """Whether the parenthesis before `begin` only groups: it follows neither a keyword nor a name."""
    before = code[:begin - 1].rstrip()
    return code[begin - 1] == "(" and (before[-1:] in _OPENS + "&|!=?:," or before.endswith("return"))


def _span(code, at):
    begin, end = _begin(code, at), _end(code, at)
    while begin > 0 and _is_grouping(code, begin) and code[end:end + 1] == ")":
        begin, end = _begin(code, begin - 1), _end(code, end + 1)
    return begin, end


def _conditions(code, begin, end):
    """[(begin, end)] of the operands of && and ||, including those inside grouping parentheses."""
    while code[begin].isspace():
        begin += 1
    while code[end - 1].isspace():
        end -= 1
    parts, depth, last = [], 0, begin
    for i in range(begin, end):
        if code[i] in _OPENS:
            depth += 1
        elif code[i] in _CLOSES:
            depth -= 1
        elif depth == 0 and i >= last and _OPERATOR.match(code, i):
            parts.append((last, i))
            last = i + 2
    parts.append((last, end))
    if len(parts) == 1:
        if code[begin] == "(" and _end(code, begin + 1) == end - 1 and _OPERATOR.search(code, begin, end):
            return _conditions(code, begin + 1, end - 1)
        return [(begin, end)]
    return [one for part in parts for one in _conditions(code, *part)]


def _behind_parenthesis(code, at):
    depth = 1
    while depth > 0 and at < len(code):
        depth += (code[at] == "(") - (code[at] == ")")
        at += 1
    return at


def _function(code, at):
    """Name of the function whose body contains `at`."""
    for match in reversed(list(_DEFINITION.finditer(code, 0, at))):
        behind = code[_behind_parenthesis(code, match.end()):]
        if match[1] not in _KEYWORDS and re.match(r"(?:\s|const|override|noexcept)*\{", behind):
            return match[1]
    return ""


def decisions_in(source):
    code, found = quiet(source), {}
    for operator in _OPERATOR.finditer(code):
        begin, end = _span(code, operator.start())
        if begin in found or re.search(r"static_assert\s*\($", code[:begin]):
            continue
        conditions = [Condition(squeezed(source[a:b]), a, b) for a, b in _conditions(code, begin, end)]
        found[begin] = Decision(_function(code, begin), squeezed(source[begin:end]), conditions)
    return list(found.values())
