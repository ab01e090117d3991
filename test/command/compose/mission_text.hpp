#pragma once

#include <string>

/// A mission as a person writes it: with comments, blanks, a part, and names unknown to Skein.
inline const std::string kMissionText = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- Two of each. -->
<mission name="survey"   domain='7' dictionary="dictionary.xml"
         vendor="cyclonedds">
  <variable name="rate" default="5"/>
  <peer name="pilot" component="pilot.xml"   restart="never"><!-- flies -->
    <csp component="careful.xml" process="own"/> <!-- slow -->

    <parameter name="Rate" value="${rate}"/>
  </peer>
	<peer name="watcher" component='watcher.xml'/>
  <future kind="a &lt; b"><![CDATA[ <peer> ]]></future>
</mission>
)";
