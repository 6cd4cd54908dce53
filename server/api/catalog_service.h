// SPDX-License-Identifier: Apache-2.0
// skinframe.v1.CatalogService. The catalogue is in memory: answered on the spot.
#pragma once

#include "server/catalog/live_catalog.h"
#include "skinframe/v1/catalog.grpc.pb.h"

namespace skinframe::server {

class CatalogService final : public v1::CatalogService::CallbackService {
 public:
  explicit CatalogService(const LiveCatalog& catalog) : catalog_(catalog) {}

  grpc::ServerUnaryReactor* ListPrinters(grpc::CallbackServerContext* context,
                                         const v1::ListPrintersRequest* request,
                                         v1::ListPrintersResponse* response) override;
  grpc::ServerUnaryReactor* ListMaterials(grpc::CallbackServerContext* context,
                                          const v1::ListMaterialsRequest* request,
                                          v1::ListMaterialsResponse* response) override;

 private:
  const LiveCatalog& catalog_;
};

}  // namespace skinframe::server
