# Qt widgets for ParaView's window, part of the plugin's library: their `interfaces` and `sources`.
include_directories("${CMAKE_CURRENT_LIST_DIR}")
set(PROGISO_WIDGETS
  # kind            type in the XML            class
  "WIDGET           isovalues                  pqIsovaluesWidget"
  "GROUP_WIDGET     isosurface_cutting         pqIsosurfaceCuttingWidget"
  "GROUP_WIDGET     isosurface_statistics      pqIsosurfaceStatisticsWidget"
  "WIDGET_DECORATOR IsosurfaceInputDecorator   pqIsosurfaceInputDecorator")
foreach (widget IN LISTS PROGISO_WIDGETS)
  separate_arguments(widget UNIX_COMMAND "${widget}")
  list(POP_FRONT widget kind type class)
  paraview_plugin_add_property_widget(
    KIND        "${kind}"
    TYPE        "${type}"
    CLASS_NAME  "${class}"
    INTERFACES  widget_interfaces
    SOURCES     widget_sources)
  list(APPEND interfaces ${widget_interfaces})
  list(APPEND sources ${widget_sources}
    "${CMAKE_CURRENT_LIST_DIR}/${class}.cxx"
    "${CMAKE_CURRENT_LIST_DIR}/${class}.h")
endforeach ()

# A distribution's ParaView names these libraries as dependencies of its window; the widgets need none of them.
foreach (library IN ITEMS Boost::boost LibXml2::LibXml2 NetCDF::NetCDF ${_qt}::OpenGL hdf5::hdf5 hdf5::hdf5_hl)
  if (NOT TARGET "${library}")
    add_library("${library}" INTERFACE IMPORTED GLOBAL)
  endif ()
endforeach ()
