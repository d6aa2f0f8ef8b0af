"""From result folders of Voussoir to a report: one page that needs nothing else."""
