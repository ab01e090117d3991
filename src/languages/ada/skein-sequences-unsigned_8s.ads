with Ada.Containers.Vectors;

package Skein.Sequences.Unsigned_8s is new Ada.Containers.Vectors (Positive, Interfaces.Unsigned_8, Interfaces."=");
