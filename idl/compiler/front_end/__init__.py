"""IDL as the OMG specifies it in version 4.2, up to a tree."""
