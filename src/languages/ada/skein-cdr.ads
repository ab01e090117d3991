with Ada.Streams;
with Ada.Strings.Unbounded;
with Ada.Strings.Wide_Unbounded;
with Interfaces;
with System;
private with Ada.Finalization;

--  Messages as XCDR1 or XCDR2 (OMG DDS-XTypes 1.3, 7.4). Generated code writes and reads values with it.
package Skein.CDR is

   use Ada.Strings.Unbounded;
   use Ada.Strings.Wide_Unbounded;
   use Interfaces;
   subtype Offset is Ada.Streams.Stream_Element_Offset;

   --  Second octets of encapsulation headers: XCDR1, and XCDR2 by the extensibility of the outermost type.
   XCDR1      : constant := 1;
   Plain      : constant := 7;
   Delimited  : constant := 9;
   Parameters : constant := 11;

   type Writer (Representation : Unsigned_8) is tagged limited private;
   function Address (From : Writer) return System.Address;
   function Size (From : Writer) return Offset;
   function Message (From : Writer) return Bytes;

   --  In XCDR2, what is written between the two has its size before it.
   function Begin_Object (Into : in out Writer) return Offset;
   procedure End_Object (Into : in out Writer; Start : Offset);
   --  The header of a member of a mutable type, to be followed by an object.
   procedure Put_Member (Into : in out Writer; Id : Unsigned_32; Must_Understand : Boolean := False);
   --  Of a sequence or a map. Raises Invalid_Argument for more than Bound, unless that is 0.
   procedure Put_Length (Into : in out Writer; Length, Bound : Natural; Place : String);

   procedure Put (Into : in out Writer; Item : Boolean);
   procedure Put (Into : in out Writer; Item : Character);
   procedure Put (Into : in out Writer; Item : Wide_Character);
   procedure Put (Into : in out Writer; Item : Short_Short_Integer);
   procedure Put (Into : in out Writer; Item : Short_Integer);
   procedure Put (Into : in out Writer; Item : Integer);
   procedure Put (Into : in out Writer; Item : Long_Long_Integer);
   procedure Put (Into : in out Writer; Item : Unsigned_8);
   procedure Put (Into : in out Writer; Item : Unsigned_16);
   procedure Put (Into : in out Writer; Item : Unsigned_32);
   procedure Put (Into : in out Writer; Item : Unsigned_64);
   procedure Put (Into : in out Writer; Item : Float);
   procedure Put (Into : in out Writer; Item : Long_Float);
   --  As binary128, with the precision of a Long_Float.
   procedure Put (Into : in out Writer; Item : Long_Long_Float);
   procedure Put (Into : in out Writer; Item : String; Bound : Natural; Place : String);
   procedure Put (Into : in out Writer; Item : Unbounded_String; Bound : Natural; Place : String);
   procedure Put (Into : in out Writer; Item : Wide_String; Bound : Natural; Place : String);
   procedure Put (Into : in out Writer; Item : Unbounded_Wide_String; Bound : Natural; Place : String);
   procedure Put (Into : in out Writer; Item : Reference);

   --  A field of a bitset in its place. Raises Invalid_Argument for a value that Width bits do not hold.
   function Field (Item : Unsigned_64; Width, First : Natural; Place : String) return Unsigned_64;
   function Field (Item : Long_Long_Integer; Width, First : Natural; Place : String) return Unsigned_64;
   function Field_Of (Bits : Unsigned_64; Width, First : Natural) return Unsigned_64;
   function Field_Of (Bits : Unsigned_64; Width, First : Natural) return Long_Long_Integer;

   --  Reads a message that Skein has checked: all members of this side's version, in their order. A Reader of a result frees it.
   type Reader is tagged limited private;
   function Read (Data : System.Address; Size : Offset; Result : Unsigned_64 := 0) return Reader;
   --  Whether there is no message.
   function Is_Empty (From : Reader) return Boolean;
   --  Whether anything is left in this object.
   function More (From : Reader) return Boolean;
   --  In XCDR2, reads an object's size, and nothing beyond it until Leave, which gets the result.
   function Enter (From : in out Reader) return Offset;
   procedure Leave (From : in out Reader; Outer : Offset);
   --  Likewise of a member of a mutable type, whose identifier it tells.
   procedure Enter_Member (From : in out Reader; Id : out Unsigned_32; Outer : out Offset);
   --  Of a sequence or a map.
   function Length (From : in out Reader) return Natural;

   procedure Get (From : in out Reader; Item : out Boolean);
   procedure Get (From : in out Reader; Item : out Character);
   procedure Get (From : in out Reader; Item : out Wide_Character);
   procedure Get (From : in out Reader; Item : out Short_Short_Integer);
   procedure Get (From : in out Reader; Item : out Short_Integer);
   procedure Get (From : in out Reader; Item : out Integer);
   procedure Get (From : in out Reader; Item : out Long_Long_Integer);
   procedure Get (From : in out Reader; Item : out Unsigned_8);
   procedure Get (From : in out Reader; Item : out Unsigned_16);
   procedure Get (From : in out Reader; Item : out Unsigned_32);
   procedure Get (From : in out Reader; Item : out Unsigned_64);
   procedure Get (From : in out Reader; Item : out Float);
   procedure Get (From : in out Reader; Item : out Long_Float);
   procedure Get (From : in out Reader; Item : out Long_Long_Float);
   procedure Get (From : in out Reader; Item : out Unbounded_String);
   procedure Get (From : in out Reader; Item : out Unbounded_Wide_String);
   procedure Get (From : in out Reader; Item : out Reference);

private

   type Store is access Bytes;

   type Writer (Representation : Unsigned_8) is new Ada.Finalization.Limited_Controlled with record
      Data : Store;
      Last : Offset := 0;
   end record;
   overriding procedure Initialize (Self : in out Writer);
   overriding procedure Finalize (Self : in out Writer);
   function Address (From : Writer) return System.Address is (From.Data.all'Address);
   function Size (From : Writer) return Offset is (From.Last);
   function Message (From : Writer) return Bytes is (From.Data (1 .. From.Last));

   --  Octets are counted from 1; the header has four.
   type Reader is new Ada.Finalization.Limited_Controlled with record
      Data    : System.Address := System.Null_Address;
      Next    : Offset := 5;
      Limit   : Offset := 0;
      XCDR2   : Boolean := False;
      Swapped : Boolean := False;
      Result  : Unsigned_64 := 0;
   end record;
   overriding procedure Finalize (Self : in out Reader);

end Skein.CDR;
