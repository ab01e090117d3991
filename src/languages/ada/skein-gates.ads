--  Between an object of Ada and the callbacks that C makes for it.
private package Skein.Gates is

   protected type Gate is
      --  C makes no callbacks any more.
      procedure Close;
      --  Until then.
      entry Wait;
      --  The object of Ada goes while C may still make some.
      procedure Detach;
      function Is_Detached return Boolean;
      --  Each of both sides needs the gate no more; the last frees it: the other may still have been within.
      procedure Leave (Is_Last : out Boolean);
   private
      Closed, Detached, One_Has_Left : Boolean := False;
   end Gate;

   --  Of a callback that found its object gone, and of one whose object could not be freed.
   Gone : constant String := "its object was finalized in a callback of its own";

end Skein.Gates;
