# keyhole_embed_page(<folder> <name> <output>): makes a source file of the page in <folder>, the PageParts <name>:
# page.html with style.css and all scripts, in the order of their names, put where it has @KEYHOLE_PAGE_STYLE@ and
# @KEYHOLE_PAGE_SCRIPT@.
function(keyhole_embed_page folder name output)
  file(GLOB scripts CONFIGURE_DEPENDS ${folder}/*.js)
  list(SORT scripts)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/page.html ${folder}/style.css ${scripts})
  file(READ ${folder}/style.css KEYHOLE_PAGE_STYLE)
  set(KEYHOLE_PAGE_SCRIPT "")
  foreach(script IN LISTS scripts)
    file(READ ${script} text)
    string(APPEND KEYHOLE_PAGE_SCRIPT "${text}")
  endforeach()
  # The data come at run time: the page is cut there.
  set(KEYHOLE_PAGE_DATA ")page\",\nR\"page(")
  file(READ ${folder}/page.html page)
  string(CONFIGURE "${page}" page @ONLY)
  file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [=[
#include "cli/page/page_parts.h"

namespace keyhole {

const PageParts @name@{R"page(@page@)page"};

} // namespace keyhole
]=])
endfunction()
