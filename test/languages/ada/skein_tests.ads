with AUnit.Test_Cases;

--  Skein for Ada: values as C++ reads, checks and writes them; a service and its callers; deaths.
package Skein_Tests is

   type Values is new AUnit.Test_Cases.Test_Case with null record;
   overriding function Name (T : Values) return AUnit.Message_String;
   overriding procedure Register_Tests (T : in out Values);

   type Calls is new AUnit.Test_Cases.Test_Case with null record;
   overriding function Name (T : Calls) return AUnit.Message_String;
   overriding procedure Register_Tests (T : in out Calls);

   --  Peers are processes, and the lease is a minute: of a death the kernel tells.
   type Deaths is new AUnit.Test_Cases.Test_Case with null record;
   overriding function Name (T : Deaths) return AUnit.Message_String;
   overriding procedure Register_Tests (T : in out Deaths);

   --  Whether the vendors that SKEIN_PAIRING names reach other processes.
   function Is_On_A_Wire return Boolean;

end Skein_Tests;
