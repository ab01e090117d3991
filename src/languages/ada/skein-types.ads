with Ada.Strings.Unbounded;
with Interfaces;

--  What a program knows of an interface, or of types alone. Generated code makes and uses it.
package Skein.Types is

   type Description is private;
   --  Of what the IDL compiler has written.
   function Make (From : Bytes) return Description;
   function Handle (Of_Type : Description) return Interfaces.Unsigned_64;

   --  A type of which a topic's values may be.
   type Topic_Type is record
      Types          : Description;
      Name           : Ada.Strings.Unbounded.Unbounded_String;
      Representation : Interfaces.Unsigned_8;
   end record;

private

   type Description is record
      Handle : Interfaces.Unsigned_64 := 0;
   end record;
   function Handle (Of_Type : Description) return Interfaces.Unsigned_64 is (Of_Type.Handle);

end Skein.Types;
