with Threats_IDL;

--  The Radar Warner's CSP Wideband, as examples/reconnaissance/threats/emitter_classification.hpp says.
package Wideband_Csp is

   use Threats_IDL;

   type Wideband is new Recon.IEmitterClassifier.Service with record
      Has_Identified : Boolean := False;
   end record;
   overriding function Classify (Self : in out Wideband; Train : Recon.PulseTrain) return Recon.Identification;

end Wideband_Csp;
