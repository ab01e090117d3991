import greeting.IGreeter;
import skein.Entity;

class Service {
  public static void main(String[] arguments) throws InterruptedException {
    try (Entity host = new Entity("host")) {
      IGreeter.provide(host, name -> "Hello, " + name + "!");
      Thread.currentThread().join();  // until it is told to end
    }
  }
}
