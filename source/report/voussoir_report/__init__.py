"""Reports of result folders of Voussoir: one self-contained page."""
