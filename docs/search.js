// How the search of the site sorts what it finds: pages before docstrings.
var Scorer = {
  score: ([page, , , , score]) => page.startsWith("docs/api/") ? score - 100 : score,
  objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
