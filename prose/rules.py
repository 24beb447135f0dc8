"""What prose has to keep: short sentences, plain turns, pages of a length that people read."""

import re
from typing import Iterator, List, NamedTuple, Tuple

from prose.texts import Sentence

MOST_WORDS = 30  # of a sentence
MOST_OF_PAGE = 2500  # words of a page, without blocks of code
MOST_OF_FIRST = 900  # words of the README of the repository

# What may not come back, and what to write for it.
TURNS: List[Tuple[str, str]] = [
    (r'\bwhat\b[^.,;:]*\b(?:is|are) what\b', 'name the thing: subject, verb, object'),
    (r'\bas no (?:\w+ )+(?:does|knows|has)\b', 'which no ... does'),
    (r'\bby what\b', 'say how, or name it'),
    (r'\b(?:lest|amid|whither|upon)\b', 'a word of today: so that ... not, among, to which, on'),
    (r'\b(?:in vain|once at most)\b', 'without success, at most once'),
    (r'\b(?:hears?|heard|bears?|borne)\b', 'receives, survives, tolerates'),
    (r'\b(?:tells?|told|telling)\b', 'says, shows, reports, gives'),
    (r'\bof that of\b|\bthat of (?:those|that)\b', 'repeat the noun'),
    (r'\bmates?\b', 'teammates, or the other robots'),
    (r'\b(?:robots?|localiser|mapper|it|they) believes?\b', 'estimates, the estimated pose'),
    (r'^What [^?:]*\.$', 'begin with the thing that acts'),
    (r'\bof yours\b|\bwhoever\b', 'your own; anybody who'),
    (r'\bup to the machine\b', 'depends on the machine'),
    (r'\bas it comes\b|\bis well\b|\blies? read-only\b', 'say what happens'),
]
_TURNS = [(re.compile(turn, re.IGNORECASE), instead) for turn, instead in TURNS]


class Fault(NamedTuple):
    """A place that breaks a rule, by the number of a line, and what is wrong there."""

    line: int
    text: str


def faults(sentences: List[Sentence]) -> Iterator[Fault]:
    """Sentences that are too long, and turns that may not come back."""
    for sentence in sentences:
        if sentence.words > MOST_WORDS:
            yield Fault(sentence.line, f'{sentence.words} words in a sentence, {MOST_WORDS} at most: {sentence.text}')
        for turn, instead in _TURNS:
            found = turn.search(sentence.text)
            if found:
                yield Fault(sentence.line, f"'{found.group()}' ({instead}): {sentence.text}")


def fault_of_length(sentences: List[Sentence], most: int) -> Iterator[Fault]:
    """A page with too many words."""
    words = sum(sentence.words for sentence in sentences)
    if words > most:
        yield Fault(1, f'{words} words on a page, {most} at most: make two pages of it, or say less')
