"""From the model to C++ and to plain DDS IDL, by templates."""
