"""Reports of runs and studies: figures, tables, conclusions and the page."""
