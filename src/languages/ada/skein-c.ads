with Interfaces.C.Extensions;
with Interfaces.C.Strings;
with System;

--  skein/c/skein.h, which has the contracts.
private package Skein.C is

   use Interfaces;
   use Interfaces.C;
   use Interfaces.C.Strings;

   subtype Handle is Unsigned_64;
   None : constant Handle := 0;

   type Value is record
      Data     : System.Address := System.Null_Address;
      Size     : size_t := 0;
      Encoding : Integer_32 := 1;  --  CDR
   end record with Convention => C_Pass_By_Copy;

   type Reserved_Words is array (1 .. 4) of Unsigned_64;

   --  All structs of callbacks look like this.
   type Callbacks is record
      User     : System.Address;
      On_Event : System.Address;
      On_Close : System.Address;
   end record with Convention => C;

   type Entity_Options is record
      Name, System_Name, Vendor : chars_ptr := Null_Ptr;
      Network                   : System.Address := System.Null_Address;
      Network_Size              : size_t := 0;
      Peers                     : System.Address := System.Null_Address;
      Peers_Size                : size_t := 0;
      Domain                    : Unsigned_32 := 0;
      Multicast                 : Extensions.bool := False;
      No_Shared_Memory_Calls    : Extensions.bool := False;
      Lease                     : Integer_64 := 0;
      Reserved                  : Reserved_Words := (others => 0);
   end record with Convention => C;

   type Connect_Options is record
      Name, System_Name, Strategy, Preferred_Host : chars_ptr := Null_Ptr;
      Provider, Constraints                       : System.Address := System.Null_Address;
      Constraints_Size                            : size_t := 0;
      Timeout, Hedge_After                        : Integer_64 := 0;
      Reserved                                    : Reserved_Words := (others => 0);
   end record with Convention => C;

   type Service_Options is record
      Attributes            : System.Address := System.Null_Address;
      Attributes_Size       : size_t := 0;
      Component, Csp, Owner : chars_ptr := Null_Ptr;
      Threads, Queue        : size_t := 0;
      Encoding              : Integer_32 := 1;
      Reserved              : Reserved_Words := (others => 0);
   end record with Convention => C;

   type Topic_Options is record
      Systems      : System.Address := System.Null_Address;
      Systems_Size : size_t := 0;
      Period       : Integer_64 := 0;
      Profile      : Integer_32 := 0;
      Strength     : Integer_32 := 0;
      Encoding     : Integer_32 := 1;
      Reserved     : Reserved_Words := (others => 0);
   end record with Convention => C;

   function skein_error_new return Handle with Import, Convention => C;
   function skein_error_free (Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_error_class (Error : Handle) return Integer_32 with Import, Convention => C;
   function skein_error_text (Error : Handle) return chars_ptr with Import, Convention => C;
   function skein_error_exception (Error : Handle; Name : out chars_ptr; Members : out Value) return Extensions.bool with Import, Convention => C;

   function skein_result_value (Result : Handle; Item : out Value; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_result_free (Result, Error : Handle) return Extensions.bool with Import, Convention => C;

   function skein_entity_new (Options : Entity_Options; Item : out Handle; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_entity_free (Entity, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_entity_id (Entity : Handle; Item : out chars_ptr; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_entity_drain (Entity : Handle; Patience : Integer_64; Drained : out Extensions.bool; Error : Handle) return Extensions.bool
     with Import, Convention => C;

   function skein_interface_new (Description : System.Address; Size : size_t; Item : out Handle; Error : Handle) return Extensions.bool
     with Import, Convention => C;

   function skein_proxy_connect
     (Entity, To : Handle; Options : Connect_Options; Item : out Handle; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_proxy_free (Proxy, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_proxy_call
     (Proxy : Handle; Operation : char_array; Arguments : Value; Timeout : Integer_64; Result : out Handle; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_proxy_start
     (Proxy : Handle; Operation : char_array; Arguments : Value; Timeout : Integer_64; Told : System.Address; Call : out Handle;
      Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_call_wait (Call : Handle; Result : out Handle; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_call_cancel (Call, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_call_free (Call, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_proxy_stream
     (Proxy : Handle; Operation : char_array; Arguments : Value; Timeout : Integer_64; Told : System.Address; Stream : out Handle;
      Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_stream_next (Stream : Handle; Result : out Handle; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_stream_free (Stream, Error : Handle) return Extensions.bool with Import, Convention => C;

   function skein_provider_new
     (Entity, Of_Interface : Handle; Options : Service_Options; Told : Callbacks; Item : out Handle; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_provider_free (Provider, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_reply_answer (Reply : Handle; Result : Value; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_reply_fail (Reply : Handle; Kind : Integer_32; Text : char_array; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_reply_raise (Reply : Handle; Name : char_array; Members : Value; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_reply_push (Reply : Handle; Item : Value; Sent : System.Address; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_reply_cancelled (Reply : Handle; Item : out Extensions.bool; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_reply_time_left (Reply : Handle; Item : out Integer_64; Error : Handle) return Extensions.bool with Import, Convention => C;

   function skein_publisher_new
     (Entity, Types : Handle; Name, Topic : char_array; Options : Topic_Options; Item : out Handle; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_publisher_publish (Publisher : Handle; Item : Value; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_publisher_subscribers (Publisher : Handle; Item : out size_t; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_publisher_free (Publisher, Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_subscription_new
     (Entity, Types : Handle; Name, Topic : char_array; Options : Topic_Options; Told : Callbacks; Item : out Handle; Error : Handle)
      return Extensions.bool with Import, Convention => C;
   function skein_subscription_publishers (Subscription : Handle; Item : out size_t; Error : Handle) return Extensions.bool
     with Import, Convention => C;
   function skein_subscription_free (Subscription, Error : Handle) return Extensions.bool with Import, Convention => C;

   function skein_log_write (Level : Integer_32; Place, Text : char_array; Error : Handle) return Extensions.bool with Import, Convention => C;
   function skein_signal_wait (Signal : out Integer_32; Error : Handle) return Extensions.bool with Import, Convention => C;

   --  GNAT counts durations in nanoseconds.
   function Nanoseconds (Time : Duration) return Integer_64 is (Integer_64'Integer_Value (Time));
   function Seconds (Time : Integer_64) return Duration is (Duration'Fixed_Value (Time));

end Skein.C;
