with Interfaces.C.Extensions;
with Interfaces.C.Strings;
with Skein.C;
with Skein.Errors;
with System;

package body Skein.Proxies is

   use Ada.Strings.Unbounded;
   use Interfaces.C;
   use Interfaces.C.Strings;
   use type Interfaces.Unsigned_64;

   function Arguments_Of (Message : CDR.Writer) return C.Value is ((Message.Address, size_t (Message.Size), others => <>));

   --  The message of a result, which the reader frees.
   function Reader_Of (Result : C.Handle) return CDR.Reader is
      Sink  : Errors.Sink;
      Value : C.Value;
   begin
      Errors.Check (C.skein_result_value (Result, Value, Sink.Id), Sink);
      return CDR.Read (Value.Data, CDR.Offset (Value.Size), Result);
   end Reader_Of;

   procedure Connect (Self : in out Proxy'Class; Own : Entities.Entity'Class; To : Types.Description; By : Choice) is
      function Made (Text : Unbounded_String) return chars_ptr is
        (if Length (Text) = 0 then Null_Ptr else New_String (To_String (Text)));
      Options : C.Connect_Options :=
        (Name => Made (By.Name), System_Name => Made (By.System), Strategy => Made (By.Strategy), Timeout => C.Nanoseconds (By.Timeout),
         others => <>);
      Sink : Errors.Sink;
      Done : constant Extensions.bool := C.skein_proxy_connect (Own.Handle, Types.Handle (To), Options, Self.Handle, Sink.Id);
   begin
      Free (Options.Name);
      Free (Options.System_Name);
      Free (Options.Strategy);
      Errors.Check (Done, Sink);
   end Connect;

   procedure Call (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration) is
      Reader : constant CDR.Reader := Call (Self, Operation, Arguments, Within) with Unreferenced;
   begin
      null;
   end Call;

   function Call (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration) return CDR.Reader is
      Sink   : Errors.Sink;
      Result : C.Handle;
   begin
      Errors.Check
        (C.skein_proxy_call (Self.Handle, To_C (Operation), Arguments_Of (Arguments), C.Nanoseconds (Within), Result, Sink.Id), Sink);
      return Reader_Of (Result);
   end Call;

   procedure Start
     (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration; Begun : in out Pending'Class)
   is
      Sink : Errors.Sink;
   begin
      Begun.Finalize;
      Begun.Operation := +Operation;
      Errors.Check
        (C.skein_proxy_start (Self.Handle, To_C (Operation), Arguments_Of (Arguments), C.Nanoseconds (Within), System.Null_Address,
                              Begun.Handle, Sink.Id), Sink);
   end Start;

   function Finish (Call : in out Pending'Class; Operation : String) return CDR.Reader is
      Sink   : Errors.Sink;
      Result : C.Handle;
   begin
      if Call.Handle = C.None then
         raise Invalid_Argument with "this call was not begun: call its Start_ procedure first";
      elsif Call.Operation /= Operation then
         raise Invalid_Argument with "this is a call of " & To_String (Call.Operation) & "(), and not of " & Operation & "()";
      end if;
      Errors.Check (C.skein_call_wait (Call.Handle, Result, Sink.Id), Sink);
      return Reader_Of (Result);
   end Finish;

   procedure Cancel (Call : in out Pending) is
      Ignored : constant Extensions.bool := C.skein_call_cancel (Call.Handle, C.None) with Unreferenced;
   begin
      null;
   end Cancel;

   procedure Start
     (Self : Proxy'Class; Operation : String; Arguments : CDR.Writer; Within : Duration; Begun : in out Result_Stream'Class)
   is
      Sink : Errors.Sink;
   begin
      Errors.Check
        (C.skein_proxy_stream (Self.Handle, To_C (Operation), Arguments_Of (Arguments), C.Nanoseconds (Within), System.Null_Address,
                               Begun.Handle, Sink.Id), Sink);
   end Start;

   function Take (From : in out Result_Stream'Class) return CDR.Reader is
      Sink   : Errors.Sink;
      Result : C.Handle;
   begin
      Errors.Check (C.skein_stream_next (From.Handle, Result, Sink.Id), Sink);
      return (if Result = C.None then CDR.Read (System.Null_Address, 0) else Reader_Of (Result));
   end Take;

   overriding procedure Finalize (Self : in out Proxy) is
      Ignored : constant Extensions.bool := C.skein_proxy_free (Self.Handle, C.None) with Unreferenced;
   begin
      Self.Handle := C.None;
   end Finalize;

   overriding procedure Finalize (Self : in out Pending) is
      Ignored : constant Extensions.bool := C.skein_call_free (Self.Handle, C.None) with Unreferenced;
   begin
      Self.Handle := C.None;
   end Finalize;

   overriding procedure Finalize (Self : in out Result_Stream) is
      Ignored : constant Extensions.bool := C.skein_stream_free (Self.Handle, C.None) with Unreferenced;
   begin
      Self.Handle := C.None;
   end Finalize;

end Skein.Proxies;
