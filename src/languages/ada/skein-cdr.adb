with Ada.Unchecked_Conversion;
with Ada.Unchecked_Deallocation;
with Interfaces.C.Extensions;
with Skein.C;

package body Skein.CDR is

   use type Offset;
   use type Ada.Streams.Stream_Element;
   use type System.Address;

   subtype Octet is Ada.Streams.Stream_Element;

   procedure Free is new Ada.Unchecked_Deallocation (Bytes, Store);
   function Bits is new Ada.Unchecked_Conversion (Float, Unsigned_32);
   function Bits is new Ada.Unchecked_Conversion (Long_Float, Unsigned_64);
   function To_Float is new Ada.Unchecked_Conversion (Unsigned_32, Float);
   function To_Float is new Ada.Unchecked_Conversion (Unsigned_64, Long_Float);
   function To_Signed is new Ada.Unchecked_Conversion (Unsigned_8, Short_Short_Integer);
   function To_Signed is new Ada.Unchecked_Conversion (Unsigned_16, Short_Integer);
   function To_Signed is new Ada.Unchecked_Conversion (Unsigned_32, Integer);
   function To_Signed is new Ada.Unchecked_Conversion (Unsigned_64, Long_Long_Integer);
   function To_Unsigned is new Ada.Unchecked_Conversion (Long_Long_Integer, Unsigned_64);

   --  Octets before a number of Size at a place behind the header.
   function Padding (Place, Size : Offset; XCDR2 : Boolean) return Offset is
     ((-Place) mod (if XCDR2 then Offset'Min (Size, 4) else Size));

   --  Writing

   overriding procedure Initialize (Self : in out Writer) is
   begin
      Self.Data := new Bytes (1 .. 256);
      Self.Data (1 .. 4) := (0, Octet (Self.Representation), 0, 0);
      Self.Last := 4;
   end Initialize;

   overriding procedure Finalize (Self : in out Writer) is
   begin
      Free (Self.Data);
   end Finalize;

   --  Room for Size octets; the place of the first.
   function Room (Into : in out Writer; Size, Alignment : Offset) return Offset is
      First  : constant Offset := Into.Last + Padding (Into.Last - 4, Alignment, Into.Representation /= XCDR1) + 1;
      Needed : constant Offset := First + Size - 1;
      Larger : Store;
   begin
      if Needed > Into.Data'Last then
         Larger := new Bytes (1 .. Offset'Max (Needed, 2 * Into.Data'Last));
         Larger (1 .. Into.Last) := Into.Data (1 .. Into.Last);
         Free (Into.Data);
         Into.Data := Larger;
      end if;
      Into.Data (Into.Last + 1 .. First - 1) := (others => 0);
      Into.Last := Needed;
      return First;
   end Room;

   --  Little-endian.
   procedure Set (Data : in out Bytes; First : Offset; Item : Unsigned_64; Size : Offset) is
   begin
      for I in 0 .. Size - 1 loop
         Data (First + I) := Octet (Shift_Right (Item, Natural (8 * I)) and 16#FF#);
      end loop;
   end Set;

   procedure Put_Bits (Into : in out Writer; Item : Unsigned_64; Size : Offset) is
      First : constant Offset := Room (Into, Size, Size);
   begin
      Set (Into.Data.all, First, Item, Size);
   end Put_Bits;

   function Begin_Object (Into : in out Writer) return Offset is
   begin
      if Into.Representation = XCDR1 then
         return 0;
      end if;
      Put (Into, Unsigned_32'(0));
      return Into.Last;
   end Begin_Object;

   procedure End_Object (Into : in out Writer; Start : Offset) is
   begin
      if Start > 0 then
         Set (Into.Data.all, Start - 3, Unsigned_64 (Into.Last - Start), 4);
      end if;
   end End_Object;

   procedure Put_Member (Into : in out Writer; Id : Unsigned_32; Must_Understand : Boolean := False) is
   begin
      Put (Into, (if Must_Understand then 2**31 else 0) or Shift_Left (Unsigned_32'(4), 28) or Id);
   end Put_Member;

   procedure Check_Bound (Count, Bound : Natural; Place : String) is
   begin
      if Bound > 0 and then Count > Bound then
         raise Invalid_Argument with Place & " takes" & Bound'Image & " at most, and was given" & Count'Image;
      end if;
   end Check_Bound;

   procedure Put_Length (Into : in out Writer; Length, Bound : Natural; Place : String) is
   begin
      Check_Bound (Length, Bound, Place);
      Put (Into, Unsigned_32 (Length));
   end Put_Length;

   procedure Put (Into : in out Writer; Item : Boolean) is
   begin
      Put_Bits (Into, Boolean'Pos (Item), 1);
   end Put;

   procedure Put (Into : in out Writer; Item : Character) is
   begin
      Put_Bits (Into, Character'Pos (Item), 1);
   end Put;

   procedure Put (Into : in out Writer; Item : Wide_Character) is
   begin
      Put_Bits (Into, Wide_Character'Pos (Item), 2);
   end Put;

   procedure Put (Into : in out Writer; Item : Short_Short_Integer) is
   begin
      Put_Bits (Into, To_Unsigned (Long_Long_Integer (Item)), 1);
   end Put;

   procedure Put (Into : in out Writer; Item : Short_Integer) is
   begin
      Put_Bits (Into, To_Unsigned (Long_Long_Integer (Item)), 2);
   end Put;

   procedure Put (Into : in out Writer; Item : Integer) is
   begin
      Put_Bits (Into, To_Unsigned (Long_Long_Integer (Item)), 4);
   end Put;

   procedure Put (Into : in out Writer; Item : Long_Long_Integer) is
   begin
      Put_Bits (Into, To_Unsigned (Item), 8);
   end Put;

   procedure Put (Into : in out Writer; Item : Unsigned_8) is
   begin
      Put_Bits (Into, Unsigned_64 (Item), 1);
   end Put;

   procedure Put (Into : in out Writer; Item : Unsigned_16) is
   begin
      Put_Bits (Into, Unsigned_64 (Item), 2);
   end Put;

   procedure Put (Into : in out Writer; Item : Unsigned_32) is
   begin
      Put_Bits (Into, Unsigned_64 (Item), 4);
   end Put;

   procedure Put (Into : in out Writer; Item : Unsigned_64) is
   begin
      Put_Bits (Into, Item, 8);
   end Put;

   procedure Put (Into : in out Writer; Item : Float) is
   begin
      Put_Bits (Into, Unsigned_64 (Bits (Item)), 4);
   end Put;

   procedure Put (Into : in out Writer; Item : Long_Float) is
   begin
      Put_Bits (Into, Bits (Item), 8);
   end Put;

   --  Between the biases of binary64 and binary128. Subnormal numbers become 0.
   Bias     : constant := 16383 - 1023;
   Fraction : constant Unsigned_64 := 2**52 - 1;

   procedure Put (Into : in out Writer; Item : Long_Long_Float) is
      Narrow   : constant Unsigned_64 := Bits (Long_Float (Item));
      Exponent : constant Unsigned_64 := Shift_Right (Narrow, 52) and 16#7FF#;
      Kept  : constant Unsigned_64 := (if Exponent = 0 then 0 else Narrow and Fraction);
      Wide     : constant Unsigned_64 := (if Exponent = 0 then 0 elsif Exponent = 16#7FF# then 16#7FFF# else Exponent + Bias);
   begin
      Put_Bits (Into, Shift_Left (Kept, 60), 8);
      Put_Bits (Into, (Narrow and 2**63) or Shift_Left (Wide, 48) or Shift_Right (Kept, 4), 8);
   end Put;

   procedure Put (Into : in out Writer; Item : String; Bound : Natural; Place : String) is
      First : Offset;
   begin
      Check_Bound (Item'Length, Bound, Place);
      Put (Into, Unsigned_32 (Item'Length + 1));
      First := Room (Into, Item'Length + 1, 1);
      for I in Item'Range loop
         if Item (I) = ASCII.NUL then
            raise Invalid_Argument with Place & " has a character of 0, which ends a string";
         end if;
         Into.Data (First + Offset (I - Item'First)) := Character'Pos (Item (I));
      end loop;
      Into.Data (Into.Last) := 0;
   end Put;

   procedure Put (Into : in out Writer; Item : Unbounded_String; Bound : Natural; Place : String) is
   begin
      Put (Into, To_String (Item), Bound, Place);
   end Put;

   procedure Put (Into : in out Writer; Item : Wide_String; Bound : Natural; Place : String) is
   begin
      Check_Bound (Item'Length, Bound, Place);
      Put (Into, Unsigned_32 (2 * Item'Length));
      for Each of Item loop
         Put (Into, Each);
      end loop;
   end Put;

   procedure Put (Into : in out Writer; Item : Unbounded_Wide_String; Bound : Natural; Place : String) is
   begin
      Put (Into, To_Wide_String (Item), Bound, Place);
   end Put;

   procedure Put (Into : in out Writer; Item : Reference) is
   begin
      Put (Into, Item.Interface_Name, 0, "a reference's interface");
      for Each of Item.Provider loop
         Put (Into, Each);
      end loop;
      Put (Into, Item.Instance, 0, "a reference's instance");
   end Put;

   --  The lowest Width bits.
   function Mask (Width : Natural) return Unsigned_64 is (if Width = 64 then Unsigned_64'Last else 2**Width - 1);

   procedure Refuse_Field (Item : String; Width : Natural; Place : String) with No_Return;
   procedure Refuse_Field (Item : String; Width : Natural; Place : String) is
   begin
      raise Invalid_Argument with Place & " has" & Width'Image & " bits, and was given" & Item;
   end Refuse_Field;

   function Field (Item : Unsigned_64; Width, First : Natural; Place : String) return Unsigned_64 is
   begin
      if (Item and Mask (Width)) /= Item then
         Refuse_Field (Item'Image, Width, Place);
      end if;
      return Shift_Left (Item, First);
   end Field;

   function Field (Item : Long_Long_Integer; Width, First : Natural; Place : String) return Unsigned_64 is
      Bits : constant Unsigned_64 := To_Unsigned (Item) and Mask (Width);
   begin
      if Long_Long_Integer'(Field_Of (Bits, Width, 0)) /= Item then
         Refuse_Field (Item'Image, Width, Place);
      end if;
      return Shift_Left (Bits, First);
   end Field;

   function Field_Of (Bits : Unsigned_64; Width, First : Natural) return Unsigned_64 is (Shift_Right (Bits, First) and Mask (Width));

   function Field_Of (Bits : Unsigned_64; Width, First : Natural) return Long_Long_Integer is
     (To_Signed (Shift_Right_Arithmetic (Shift_Left (Bits, 64 - Width - First), 64 - Width)));

   --  Reading

   procedure Ignore (Done : Interfaces.C.Extensions.bool) is null;

   overriding procedure Finalize (Self : in out Reader) is
   begin
      Ignore (C.skein_result_free (Self.Result, C.None));
      Self.Result := C.None;
   end Finalize;

   function Read (Data : System.Address; Size : Offset; Result : Unsigned_64 := 0) return Reader is
   begin
      return Made : Reader do
         Made.Result := Result;
         if Size >= 4 then
            declare
               Header : constant Bytes (1 .. 4) with Import, Address => Data;
            begin
               Made.Data := Data;
               Made.Limit := Size;
               Made.XCDR2 := Header (2) > XCDR1;
               Made.Swapped := Header (2) mod 2 = 0;
            end;
         end if;
      end return;
   end Read;

   function Is_Empty (From : Reader) return Boolean is (From.Data = System.Null_Address);

   function More (From : Reader) return Boolean is (From.Next <= From.Limit);

   procedure Demand (From : Reader; Size : Offset) is
   begin
      if Size > From.Limit - From.Next + 1 then
         raise Invalid_Argument with "a message is shorter than its value";
      end if;
   end Demand;

   function Get_Bits (From : in out Reader; Size : Offset) return Unsigned_64 is
      Result : Unsigned_64 := 0;
   begin
      From.Next := From.Next + Padding (From.Next - 5, Size, From.XCDR2);
      Demand (From, Size);
      declare
         Data : constant Bytes (1 .. From.Limit) with Import, Address => From.Data;
      begin
         for I in 0 .. Size - 1 loop
            Result := Result
              or Shift_Left (Unsigned_64 (Data (From.Next + I)), Natural (8 * (if From.Swapped then Size - 1 - I else I)));
         end loop;
      end;
      From.Next := From.Next + Size;
      return Result;
   end Get_Bits;

   function Enter (From : in out Reader) return Offset is
      Outer : constant Offset := From.Limit;
      Size  : Offset;
   begin
      if not From.XCDR2 then
         return 0;
      end if;
      Size := Offset (Get_Bits (From, 4));
      Demand (From, Size);
      From.Limit := From.Next + Size - 1;
      return Outer;
   end Enter;

   procedure Leave (From : in out Reader; Outer : Offset) is
   begin
      if Outer > 0 then
         From.Next := From.Limit + 1;
         From.Limit := Outer;
      end if;
   end Leave;

   procedure Enter_Member (From : in out Reader; Id : out Unsigned_32; Outer : out Offset) is
      Header : constant Unsigned_64 := Get_Bits (From, 4);
      Code   : constant Natural := Natural (Shift_Right (Header, 28) and 7);
   begin
      Id := Unsigned_32 (Header and 16#FFF_FFFF#);
      if Code >= 4 then
         Outer := Enter (From);
      else
         Demand (From, 2**Code);
         Outer := From.Limit;
         From.Limit := From.Next + 2**Code - 1;
      end if;
   end Enter_Member;

   function Length (From : in out Reader) return Natural is
      Result : constant Offset := Offset (Get_Bits (From, 4));
   begin
      Demand (From, Result);
      return Natural (Result);
   end Length;

   procedure Get (From : in out Reader; Item : out Boolean) is
   begin
      Item := Get_Bits (From, 1) /= 0;
   end Get;

   procedure Get (From : in out Reader; Item : out Character) is
   begin
      Item := Character'Val (Get_Bits (From, 1));
   end Get;

   procedure Get (From : in out Reader; Item : out Wide_Character) is
   begin
      Item := Wide_Character'Val (Get_Bits (From, 2));
   end Get;

   procedure Get (From : in out Reader; Item : out Short_Short_Integer) is
   begin
      Item := To_Signed (Unsigned_8 (Get_Bits (From, 1)));
   end Get;

   procedure Get (From : in out Reader; Item : out Short_Integer) is
   begin
      Item := To_Signed (Unsigned_16 (Get_Bits (From, 2)));
   end Get;

   procedure Get (From : in out Reader; Item : out Integer) is
   begin
      Item := To_Signed (Unsigned_32 (Get_Bits (From, 4)));
   end Get;

   procedure Get (From : in out Reader; Item : out Long_Long_Integer) is
   begin
      Item := To_Signed (Get_Bits (From, 8));
   end Get;

   procedure Get (From : in out Reader; Item : out Unsigned_8) is
   begin
      Item := Unsigned_8 (Get_Bits (From, 1));
   end Get;

   procedure Get (From : in out Reader; Item : out Unsigned_16) is
   begin
      Item := Unsigned_16 (Get_Bits (From, 2));
   end Get;

   procedure Get (From : in out Reader; Item : out Unsigned_32) is
   begin
      Item := Unsigned_32 (Get_Bits (From, 4));
   end Get;

   procedure Get (From : in out Reader; Item : out Unsigned_64) is
   begin
      Item := Get_Bits (From, 8);
   end Get;

   procedure Get (From : in out Reader; Item : out Float) is
   begin
      Item := To_Float (Unsigned_32 (Get_Bits (From, 4)));
   end Get;

   procedure Get (From : in out Reader; Item : out Long_Float) is
   begin
      Item := To_Float (Get_Bits (From, 8));
   end Get;

   procedure Get (From : in out Reader; Item : out Long_Long_Float) is
      First  : constant Unsigned_64 := Get_Bits (From, 8);
      Second : constant Unsigned_64 := Get_Bits (From, 8);
      Low    : constant Unsigned_64 := (if From.Swapped then Second else First);
      High   : constant Unsigned_64 := (if From.Swapped then First else Second);
      Wide   : constant Unsigned_64 := Shift_Right (High, 48) and 16#7FFF#;
      Kept   : constant Unsigned_64 := Shift_Left (High and (2**48 - 1), 4) or Shift_Right (Low, 60);
      Narrow : constant Unsigned_64 :=
        (if Wide <= Bias then 0
         elsif Wide = 16#7FFF# then Shift_Left (Unsigned_64'(16#7FF#), 52) or Kept
         elsif Wide - Bias >= 16#7FF# then Shift_Left (Unsigned_64'(16#7FF#), 52)
         else Shift_Left (Wide - Bias, 52) or Kept);
   begin
      Item := Long_Long_Float (To_Float ((High and 2**63) or Narrow));
   end Get;

   procedure Get (From : in out Reader; Item : out Unbounded_String) is
      Size : constant Offset := Offset (Length (From));
      Data : constant String (1 .. Integer (From.Limit)) with Import, Address => From.Data;
   begin
      Item := To_Unbounded_String (Data (Integer (From.Next) .. Integer (From.Next + Size) - 2));
      From.Next := From.Next + Size;
   end Get;

   procedure Get (From : in out Reader; Item : out Unbounded_Wide_String) is
      Each : Wide_Character;
   begin
      Item := Null_Unbounded_Wide_String;  --  a text of any size does not fit on the stack of a thread of C
      for I in 1 .. Length (From) / 2 loop
         Get (From, Each);
         Append (Item, Each);
      end loop;
   end Get;

   procedure Get (From : in out Reader; Item : out Reference) is
   begin
      Get (From, Item.Interface_Name);
      for Each of Item.Provider loop
         Get (From, Each);
      end loop;
      Get (From, Item.Instance);
   end Get;

end Skein.CDR;
