with Ada.Numerics.Long_Elementary_Functions;
with Ada.Strings.Unbounded;
with Ada.Text_IO;
with Skein;

package body Wideband_Csp is

   use Ada.Numerics.Long_Elementary_Functions;
   use Ada.Strings.Unbounded;
   use Recon;
   use Skein;

   function Erfc (X : Long_Float) return Long_Float with Import, Convention => C, External_Name => "erfc";

   Needed : constant := 16;  --  intercepts

   type Quantity is (Frequency, Pulse_Interval, Scan);
   type Interval is record
      Least, Greatest : Long_Float;
   end record;
   type Intervals is array (Quantity) of Interval;
   type Values is array (Quantity) of Long_Float;
   type Emitter_Class is record
      Emitter : Unbounded_String;
      Mode    : RadarMode;
      Of_It   : Intervals;
      Prior   : Long_Float;
   end record;

   Short_Range  : constant Unbounded_String := +"short-range site";
   Medium_Range : constant Unbounded_String := +"medium-range site";
   Gun          : constant Unbounded_String := +"mobile gun";
   Surveillance : constant Unbounded_String := +"air surveillance";

   Library : constant array (1 .. 11) of Emitter_Class :=
     ((Short_Range, Search, ((2.9E9, 3.1E9), (0.8E-3, 1.2E-3), (3.5, 4.5)), 3.0),
      (Short_Range, Track, ((8.6E9, 9.0E9), (180.0E-6, 220.0E-6), (0.0, 0.0)), 2.0),
      (Short_Range, Guidance, ((8.9E9, 9.2E9), (45.0E-6, 60.0E-6), (0.0, 0.0)), 1.0),
      (Medium_Range, Search, ((3.0E9, 3.3E9), (1.1E-3, 1.6E-3), (4.0, 6.0)), 3.0),
      (Medium_Range, Track, ((8.8E9, 9.4E9), (200.0E-6, 260.0E-6), (0.0, 0.0)), 2.0),
      (Medium_Range, Guidance, ((9.1E9, 9.6E9), (55.0E-6, 75.0E-6), (0.0, 0.0)), 1.0),
      (Gun, Search, ((14.0E9, 15.0E9), (90.0E-6, 130.0E-6), (1.5, 2.5)), 2.0),
      (Gun, Track, ((14.5E9, 15.5E9), (80.0E-6, 110.0E-6), (0.0, 0.0)), 1.0),
      (+"coast radar", Search, ((3.0E9, 3.1E9), (1.0E-3, 1.3E-3), (2.5, 3.8)), 1.0),
      (Surveillance, Search, ((1.25E9, 1.35E9), (2.5E-3, 4.0E-3), (9.0, 12.0)), 2.0),
      (Surveillance, Track, ((3.1E9, 3.4E9), (1.5E-3, 2.2E-3), (5.0, 8.0)), 1.0));
   Unknown       : constant Emitter_Class := (+"", Off, ((0.5E9, 40.0E9), (1.0E-6, 1.0E-2), (0.0, 20.0)), 0.0);
   Unknown_Prior : constant := 0.01;

   function Measured (From : Intercept) return Values is ((From.Frequency_Hz, From.Pulse_Interval_S, From.Scan_S));

   --  Of one measurement.
   function Sigmas (Of_It : Values) return Values is ((20.0E6, 0.02 * Of_It (Pulse_Interval), 0.2));

   --  Of a value uniform in an interval with a normal error.
   function Density (Value, Sigma : Long_Float; Within : Interval) return Long_Float is
      Width : constant Long_Float := Within.Greatest - Within.Least;
      function Below (Bound : Long_Float) return Long_Float is (0.5 * Erfc ((Bound - Value) / (Sigma * Sqrt (2.0))));
   begin
      if Width > 1.0E-6 * Sigma then
         return (Below (Within.Least) - Below (Within.Greatest)) / Width;
      end if;
      return Exp (-0.5 * ((Value - Within.Least) / Sigma)**2) / (Sigma * Sqrt (2.0 * Ada.Numerics.Pi));
   end Density;

   function By_Bayes (Mean, Errors : Values) return Identification is
      Best   : Identification;
      Sum    : Long_Float := 0.0;
      Priors : Long_Float := 0.0;

      procedure Consider (Class : Emitter_Class; Prior : Long_Float) is
         Probability : Long_Float := Prior;
      begin
         for Each in Quantity loop
            Probability := Probability * Density (Mean (Each), Errors (Each), Class.Of_It (Each));
         end loop;
         Sum := Sum + Probability;
         if Probability > Best.Confidence then
            Best := (Class.Emitter, Class.Mode, Probability);
         end if;
      end Consider;
   begin
      for Class of Library loop
         Priors := Priors + Class.Prior;
      end loop;
      for Class of Library loop
         Consider (Class, (1.0 - Unknown_Prior) * Class.Prior / Priors);
      end loop;
      Consider (Unknown, Unknown_Prior);
      if Sum <= 0.0 then
         return (+"", Off, 1.0);
      end if;
      Best.Confidence := Best.Confidence / Sum;
      return Best;
   end By_Bayes;

   overriding function Classify (Self : in out Wideband; Train : PulseTrain) return Identification is
      Last    : constant Natural := Natural (Train.Intercepts.Length);
      Mean    : Values := (others => 0.0);
      Errors  : Values;
      Freedom : constant Long_Float := Long_Float (Needed - 1);
      Spread  : Long_Float;
   begin
      if Last < Needed then
         Raise_NotSure ((Reason => +"it needs more pulses of one mode"));
      end if;
      for I in Last - Needed + 1 .. Last loop
         for Each in Quantity loop
            Mean (Each) := Mean (Each) + Measured (Train.Intercepts (I)) (Each) / Long_Float (Needed);
         end loop;
      end loop;
      Errors := Sigmas (Mean);
      for Each in Quantity loop
         Spread := 0.0;
         for I in Last - Needed + 1 .. Last loop
            Spread := Spread + ((Measured (Train.Intercepts (I)) (Each) - Mean (Each)) / Errors (Each))**2;
         end loop;
         if Spread >= Freedom + 5.0 * Sqrt (2.0 * Freedom) then
            Raise_NotSure ((Reason => +"it needs more pulses of one mode"));
         end if;
         Errors (Each) := Errors (Each) / Sqrt (Long_Float (Needed));
      end loop;
      if not Self.Has_Identified then
         Self.Has_Identified := True;
         Ada.Text_IO.Put_Line ("Wideband identifies in Ada");
         Ada.Text_IO.Flush;
      end if;
      return By_Bayes (Mean, Errors);
   end Classify;

end Wideband_Csp;
