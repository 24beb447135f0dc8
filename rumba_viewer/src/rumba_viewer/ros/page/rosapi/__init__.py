"""The services of rosapi that the page offers: topics, types, parameters, the graph."""
