with Ada.Exceptions;
with Ada.Finalization;
with Interfaces.C.Extensions;

--  Errors of the flat interface as exceptions.
package Skein.Errors is

   use Ada.Exceptions;

   --  The whole text of an exception of Skein's, which is one of the last eight that this task has caught: cause, place and remedy.
   function Text (Error : Exception_Occurrence) return String;

   --  What follows is for generated code.

   --  Ties an exception to its name in IDL.
   procedure Register (Name : String; Id : Exception_Id);
   --  Its name in IDL; empty for an exception that is not of IDL.
   function Name_Of (Id : Exception_Id) return String;
   --  Raises an exception of IDL with its members, a message of CDR, which stay with this task until it has raised eight more.
   procedure Raise_With (Id : Exception_Id; Members : Bytes) with No_Return;
   --  Raises Invalid_Argument for one that was not raised by Raise_With, or too long ago.
   function Members (Error : Exception_Occurrence) return Bytes;

   --  Where a function of C puts its error.
   type Sink is new Ada.Finalization.Limited_Controlled with record
      Id : Interfaces.Unsigned_64 := 0;
   end record;
   overriding procedure Initialize (Self : in out Sink);
   overriding procedure Finalize (Self : in out Sink);
   --  Raises the error of a function that has failed.
   procedure Check (Done : Interfaces.C.Extensions.bool; From : Sink);
   --  Whether it is one of Skein's exceptions, and its class in C: Internal's for all others.
   function Is_Skein (Id : Exception_Id) return Boolean;
   function Class_Of (Id : Exception_Id) return Interfaces.Integer_32;

end Skein.Errors;
