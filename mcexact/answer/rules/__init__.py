"""When each sentence about a system is said: rules that read certified claims and nothing else."""

from mcexact.answer.rules import allocation, analysis, details, links
from mcexact.answer.sentence import Rulebook

ANALYSIS = Rulebook([*analysis.RULES, *details.RULES])
ALLOCATION = allocation.RULES
LINKS = links.RULES
