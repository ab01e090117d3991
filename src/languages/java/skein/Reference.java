package skein;

/** A service as a value: what an IDL type has where it names an interface. The provider's identity has 16 bytes. */
public record Reference(String interfaceName, byte[] provider, String instance) {
  public static final Reference NONE = new Reference("", new byte[16], "");
}
