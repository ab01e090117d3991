// A library that knows nothing of Skein.
extern "C" int skein_nothing() { return 0; }
