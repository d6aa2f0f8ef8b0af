# Voussoir from Debian's packages; see "In a container" in doc/first_run.md.
ARG DEBIAN=12

FROM debian:${DEBIAN} AS build
WORKDIR /src
COPY bootstrap ./
RUN ./bootstrap install
COPY . ./
# by default for processors with AVX2, as nearly all since 2015
ARG MARCH=x86-64-v3
ARG JOBS=2
RUN cmake --preset release -DVOUSSOIR_NATIVE=OFF -DCMAKE_CXX_FLAGS=-march=${MARCH} && \
    cmake --build --preset release --target voussoir -j ${JOBS} && \
    cmake --install build --prefix /opt/voussoir && \
    dpkg-query -W -f '${Package}\n' 'libdeal.ii-[0-9]*' 'libfftw3-double3*' >/opt/voussoir/packages

FROM debian:${DEBIAN}
COPY --from=build /opt/voussoir /opt/voussoir
# what runs it, and makes its reports
RUN apt-get update && \
    DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      $(cat /opt/voussoir/packages) openmpi-bin \
      python3-numpy python3-matplotlib python3-vtk9 python3-jinja2 xvfb && \
    rm -rf /var/lib/apt/lists/*
# root may, and others without a home; without what a container forbids or has not (see set_up_mpi in voussoir-run)
ENV PATH=/opt/voussoir/bin:$PATH HOME=/tmp \
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_btl=^uct,openib,ofi OMPI_MCA_btl_vader_single_copy_mechanism=none \
    OMPI_MCA_orte_execute_quiet=1 \
    HWLOC_HIDE_ERRORS=2
WORKDIR /work
CMD ["voussoir", "--help"]
