package skein;

import com.sun.jna.Callback;
import com.sun.jna.CallbackThreadInitializer;
import com.sun.jna.Native;
import java.util.Set;
import java.util.concurrent.ConcurrentHashMap;

/** Functions of Java that C may call, until C says that it will not any more. */
final class CallbackKeeper {
  private static final Set<C.Callbacks> KEPT = ConcurrentHashMap.newKeySet();
  // Threads of Skein's stay attached to the virtual machine, which must not wait for them at its end.
  private static final CallbackThreadInitializer THREADS = new CallbackThreadInitializer(true, false, "skein");

  private CallbackKeeper() {}

  static C.Callbacks keep(Callback function) {
    C.Callbacks callbacks = new C.Callbacks();
    callbacks.function = function;
    callbacks.onClose = user -> KEPT.remove(callbacks);
    Native.setCallbackThreadInitializer(function, THREADS);
    Native.setCallbackThreadInitializer(callbacks.onClose, THREADS);
    KEPT.add(callbacks);
    return callbacks;
  }

  /** The function that was to take them has failed. */
  static void drop(C.Callbacks callbacks) {
    KEPT.remove(callbacks);
  }
}
