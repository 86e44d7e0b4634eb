# Qt widgets for ParaView's window, part of the plugin's library: their `interfaces` and `sources`.
include_directories("${CMAKE_CURRENT_LIST_DIR}")
paraview_plugin_add_property_widget(
  KIND        GROUP_WIDGET
  TYPE        "isosurface_statistics"
  CLASS_NAME  pqIsosurfaceStatisticsWidget
  INTERFACES  interfaces
  SOURCES     sources)
list(APPEND sources
  "${CMAKE_CURRENT_LIST_DIR}/pqIsosurfaceStatisticsWidget.cxx"
  "${CMAKE_CURRENT_LIST_DIR}/pqIsosurfaceStatisticsWidget.h")

# A distribution's ParaView names these libraries as dependencies of its window; the widgets need none of them.
foreach (library IN ITEMS Boost::boost LibXml2::LibXml2 NetCDF::NetCDF ${_qt}::OpenGL hdf5::hdf5 hdf5::hdf5_hl)
  if (NOT TARGET "${library}")
    add_library("${library}" INTERFACE IMPORTED GLOBAL)
  endif ()
endforeach ()
