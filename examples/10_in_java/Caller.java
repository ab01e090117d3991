import greeting.IGreeter;
import skein.Entity;

class Caller {
  public static void main(String[] arguments) throws Exception {
    Entity.Options options = new Entity.Options("guest");
    options.vendor = "fastdds";
    try (Entity guest = new Entity(options)) {
      IGreeter.Proxy greeter = IGreeter.connect(guest);
      System.out.println(greeter.greet("world"));
      System.out.println(greeter.greetAsync("later").get());
    }
  }
}
