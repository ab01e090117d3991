package body Skein.Gates is

   protected body Gate is

      procedure Close is
      begin
         Closed := True;
      end Close;

      entry Wait when Closed is
      begin
         null;
      end Wait;

      procedure Detach is
      begin
         Detached := True;
      end Detach;

      procedure Leave (Is_Last : out Boolean) is
      begin
         Is_Last := One_Has_Left;
         One_Has_Left := True;
      end Leave;

      function Is_Detached return Boolean is (Detached);

   end Gate;

end Skein.Gates;
