with Ada.Command_Line;
with AUnit.Reporter.Text;
with AUnit.Run;
with AUnit.Test_Suites;
with Skein_Tests;

--  SKEIN_PAIRING=VENDOR:VENDOR, of the provider and of the caller; SKEIN_BUOY_PEER, the program of that name.
procedure Run_Tests is

   use type AUnit.Status;

   pragma Warnings (Off, "use of an anonymous access type allocator");  --  which AUnit asks for

   function Suite return AUnit.Test_Suites.Access_Test_Suite is
   begin
      return All_Tests : constant AUnit.Test_Suites.Access_Test_Suite := AUnit.Test_Suites.New_Suite do
         All_Tests.Add_Test (new Skein_Tests.Calls);
         if Skein_Tests.Is_On_A_Wire then
            All_Tests.Add_Test (new Skein_Tests.Deaths);
         else
            All_Tests.Add_Test (new Skein_Tests.Values);
         end if;
      end return;
   end Suite;

   function Run is new AUnit.Run.Test_Runner_With_Status (Suite);
   Reporter : AUnit.Reporter.Text.Text_Reporter;
begin
   if Run (Reporter) /= AUnit.Success then
      Ada.Command_Line.Set_Exit_Status (Ada.Command_Line.Failure);
   end if;
end Run_Tests;
