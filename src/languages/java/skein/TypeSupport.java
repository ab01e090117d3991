package skein;

/** What topics know of a type. Generated code makes it. */
public record TypeSupport<T>(InterfaceType types, String name, int representation, Codec<T> codec) {}
