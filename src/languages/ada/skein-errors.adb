with Ada.Containers.Indefinite_Holders;
with Ada.Containers.Indefinite_Ordered_Maps;
with Ada.Strings.Fixed;
with Ada.Strings.Unbounded;
with Ada.Task_Attributes;
with Interfaces.C.Strings;
with Skein.C;

package body Skein.Errors is

   use Ada.Strings.Unbounded;
   use type Ada.Streams.Stream_Element_Array;
   use type Interfaces.Integer_32;

   package Messages is new Ada.Containers.Indefinite_Holders (Bytes);
   package Exceptions is new Ada.Containers.Indefinite_Ordered_Maps (String, Exception_Id);

   --  What a task has raised lately. Messages of exceptions of IDL end with a number that no other one has.
   type Raised is record
      Id      : Exception_Id := Null_Id;
      Message : Unbounded_String;
      Text    : Unbounded_String;
      Members : Messages.Holder;
   end record;
   type Number is mod 8;
   type Raised_List is array (Number) of Raised;
   type History is record
      List  : Raised_List;
      Next  : Number := 0;
      Count : Natural := 0;
   end record;
   package Histories is new Ada.Task_Attributes (History, (others => <>));

   --  Written while packages are elaborated, and then only read.
   Declared : Exceptions.Map;

   Greatest_Message : constant := 200;  --  GNAT cuts there
   Declared_Class   : constant := 9;
   Internal_Class   : constant := 8;
   Classes : constant array (Interfaces.Integer_32 range 1 .. Internal_Class) of Exception_Id :=
     (Unavailable'Identity, Overloaded'Identity, Disconnected'Identity, Timed_Out'Identity, Cancelled'Identity, Unimplemented'Identity,
      Invalid_Argument'Identity, Internal'Identity);

   --  As many octets as fit, without the beginning of a character of UTF-8.
   function Shortened (Text : String; Octets : Natural) return String is
      Last : Integer := Integer'Min (Text'Last, Text'First + Octets - 1);
   begin
      while Last in Text'First .. Text'Last - 1 and then Character'Pos (Text (Last + 1)) in 16#80# .. 16#BF# loop
         Last := Last - 1;
      end loop;
      return Text (Text'First .. Last);
   end Shortened;

   procedure Raise_Text (Id : Exception_Id; Text : String; Members : Messages.Holder) with No_Return;

   procedure Raise_Text (Id : Exception_Id; Text : String; Members : Messages.Holder) is
      Known   : History renames Histories.Reference.all;
      Numbers : constant String := (if Members.Is_Empty then "" else " #" & Ada.Strings.Fixed.Trim (Known.Count'Image, Ada.Strings.Left));
      Message : constant String := Shortened (Text, Greatest_Message - Numbers'Length) & Numbers;
   begin
      Known.List (Known.Next) := (Id, To_Unbounded_String (Message), To_Unbounded_String (Text), Members);
      Known.Next := Known.Next + 1;
      Known.Count := (if Known.Count = Natural'Last then 0 else Known.Count + 1);
      Raise_Exception (Id, Message);
   end Raise_Text;

   --  What is known of an exception that this task has raised; nothing of another one.
   function Found (Error : Exception_Occurrence) return Raised is
      Known : History renames Histories.Reference.all;
   begin
      for Back in Number loop
         if Known.List (Known.Next - 1 - Back).Id = Exception_Identity (Error)
           and then Known.List (Known.Next - 1 - Back).Message = Exception_Message (Error)
         then
            return Known.List (Known.Next - 1 - Back);
         end if;
      end loop;
      return (Text => To_Unbounded_String (Exception_Message (Error)), others => <>);
   end Found;

   function Text (Error : Exception_Occurrence) return String is (To_String (Found (Error).Text));

   procedure Register (Name : String; Id : Exception_Id) is
   begin
      Declared.Include (Name, Id);
   end Register;

   function Name_Of (Id : Exception_Id) return String is
   begin
      for Each in Declared.Iterate loop
         if Exceptions.Element (Each) = Id then
            return Exceptions.Key (Each);
         end if;
      end loop;
      return "";
   end Name_Of;

   procedure Raise_With (Id : Exception_Id; Members : Bytes) is
   begin
      Raise_Text (Id, Name_Of (Id), Messages.To_Holder (Members));
   end Raise_With;

   function Members (Error : Exception_Occurrence) return Bytes is
      Known : constant Raised := Found (Error);
   begin
      if Known.Members.Is_Empty then
         raise Invalid_Argument with Exception_Name (Error) & " has no members: raise it by its Raise_ procedure, and ask for them "
           & "before this task has raised eight more";
      end if;
      return Known.Members.Element;
   end Members;

   overriding procedure Initialize (Self : in out Sink) is
   begin
      Self.Id := C.skein_error_new;
   end Initialize;

   overriding procedure Finalize (Self : in out Sink) is
      Ignored : constant Interfaces.C.Extensions.bool := C.skein_error_free (Self.Id) with Unreferenced;
   begin
      Self.Id := 0;
   end Finalize;

   function Copy (From : C.Value) return Messages.Holder is
      Message : constant Bytes (1 .. Ada.Streams.Stream_Element_Offset (From.Size)) with Import, Address => From.Data;
   begin
      return Messages.To_Holder (Message);
   end Copy;

   procedure Check (Done : Interfaces.C.Extensions.bool; From : Sink) is
      Name    : Interfaces.C.Strings.chars_ptr;
      Members : C.Value;
   begin
      if Done then
         return;
      end if;
      declare
         Class : constant Interfaces.Integer_32 := C.skein_error_class (From.Id);
         Text  : constant String := Interfaces.C.Strings.Value (C.skein_error_text (From.Id));
      begin
         if Class = Declared_Class and then Boolean (C.skein_error_exception (From.Id, Name, Members))
           and then Declared.Contains (Interfaces.C.Strings.Value (Name))
         then
            Raise_Text (Declared (Interfaces.C.Strings.Value (Name)), Text, Copy (Members));
         end if;
         Raise_Text (Classes (if Class in Classes'Range then Class else Internal_Class), Text, Messages.Empty_Holder);
      end;
   end Check;

   function Is_Skein (Id : Exception_Id) return Boolean is (for some Each of Classes => Each = Id);

   function Class_Of (Id : Exception_Id) return Interfaces.Integer_32 is
   begin
      for Class in Classes'Range loop
         if Classes (Class) = Id then
            return Class;
         end if;
      end loop;
      return Internal_Class;
   end Class_Of;

end Skein.Errors;
