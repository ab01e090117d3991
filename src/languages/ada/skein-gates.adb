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

      procedure Detach (Is_Closed : out Boolean) is
      begin
         Detached := True;
         Is_Closed := Closed;
      end Detach;

      function Is_Detached return Boolean is (Detached);

   end Gate;

end Skein.Gates;
